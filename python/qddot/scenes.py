"""Generators of scenes: qddot.scenes.cloth(nodes=30). dir(qddot.scenes) lists them, and help() says
which parameters each takes, with their ranges."""

from __future__ import annotations

import inspect
from typing import Any, Protocol

from qddot import _qddot
from qddot._names import hint
from qddot._scene import Scene


class Generator(Protocol):
    """Draws a scene; parameters that are not given have their default values."""

    def __call__(self, **parameters: float) -> Scene: ...


def _draw(record: dict[str, Any]) -> Generator:
    name: str = record["name"]

    names = [p["name"] for p in record["parameters"]]

    def draw(**parameters: float) -> Scene:
        for other in parameters:
            if other not in names:
                raise ValueError(
                    f"{other} is not a parameter of {name}{hint(other, names)}; allowed are "
                    f"{', '.join(names)}"
                )
        return Scene._of(_qddot.Scene.generate(name, parameters))

    lines = [record["summary"], ""]
    signature = []
    for p in record["parameters"]:
        lines.append(f"{p['name']}: {p['meaning']}; from {p['low']:g} to {p['high']:g}")
        standard = int(p["standard"]) if p["whole"] else p["standard"]
        kind = inspect.Parameter.KEYWORD_ONLY
        signature.append(inspect.Parameter(p["name"], kind, default=standard))
    draw.__name__ = draw.__qualname__ = name
    draw.__doc__ = "\n".join(lines)
    setattr(draw, "__signature__", inspect.Signature(signature))
    return draw


_generators = {record["name"]: _draw(record) for record in _qddot.generators()}


def __getattr__(name: str) -> Generator:
    try:
        return _generators[name]
    except KeyError:
        those = ", ".join(_generators)
        raise AttributeError(
            f"{name} is no generator of scenes{hint(name, _generators)}; there are {those}"
        ) from None


def __dir__() -> list[str]:
    return [*_generators, "Generator"]
