"""The registry of methods."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Callable

import numpy as np

from qddot import _qddot
from qddot._arrays import count, number
from qddot._names import F, hint


@dataclass(frozen=True, repr=False)
class Method:
    """A method (integrator): an entry of the registry.

    `order` is that of the global error, 0 if there is none. `knob` is the number that trades speed
    for accuracy: "step_size" [s] or "rtol". `stability_limit` is the largest h w at which no
    oscillation grows with an explicit method of fixed steps; None for others. `takes` has the
    options of solve() that the method uses. `needs` has what it requires of a System beside its
    forces.
    """

    name: str
    summary: str
    source: str
    order: int
    family: str
    knob: str
    stability_limit: float | None
    traits: tuple[str, ...]
    needs: tuple[str, ...]
    takes: tuple[str, ...]
    stock_of: str

    def __repr__(self) -> str:
        order = f"order {self.order}" if self.order > 0 else "exact"
        return f"<qddot.Method {self.name!r}: {order}, {self.knob}; {self.summary}>"


@lru_cache(maxsize=None)
def _all() -> dict[str, Method]:
    return {record["name"]: Method(**record) for record in _qddot.methods()}


def methods() -> list[Method]:
    """All methods, in the order of lists and pictures."""
    return list(_all().values())


def method(name: str) -> Method:
    """The method of that name. If there is none, raises a ValueError that names all methods."""
    found = _all().get(name) if isinstance(name, str) else None
    if found is None:
        why = _qddot.why_not_built(name) if isinstance(name, str) else ""
        if why:
            raise ValueError(why)
        nearest = hint(name, _all()) if isinstance(name, str) else ""
        raise ValueError(f"{name!r} is no method{nearest}; there are {', '.join(_all())}")
    return found


def _whole(value: Any, name: str) -> int:
    return count(value, name, 0)


def _flag(value: Any, name: str) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise ValueError(f"{name}: {value!r} is neither True nor False")


def _word(value: Any, name: str) -> str:
    if isinstance(value, str):
        return value
    raise ValueError(f"{name}: {value!r} is no name")


_KINDS: dict[str, Callable[[Any, str], Any]] = {
    "number": number,
    "integer": _whole,
    "flag": _flag,
    "solver": _word,
}
# The rows of the table of options (option_table.hpp) that a call may give.
_OPTIONS = {row["name"]: row for row in _qddot.options() if row["takers"] != "all"}
_OF_KNOBS = {name: row["takers"] for name, row in _OPTIONS.items() if row["takers"] != "takes"}


def options_in(arguments: dict[str, Any]) -> dict[str, Any]:
    """Those of a function's arguments that are options of a run, in the table's order."""
    return {name: arguments[name] for name in _OPTIONS if name in arguments}


def lists_options(function: F) -> F:
    """The same function, whose documentation ends with the options of Method.takes."""
    rows = [f"    {n}: {row['words']}." for n, row in _OPTIONS.items() if n not in _OF_KNOBS]
    function.__doc__ = "\n".join([(function.__doc__ or "").rstrip(), "", *rows, "    "])
    return function


def _checked(value: Any, name: str) -> Any:
    kind = _OPTIONS[name]["kind"] if name in _OPTIONS else "number"
    return _KINDS[kind](value, name)


def options_for(
    chosen: Method, given: dict[str, Any], beside: tuple[str, ...] = ()
) -> dict[str, Any]:
    """The given options in the form that the method takes. Raises ValueError for options that it
    ignores, and if its knob is missing. `beside`: names of other arguments, one of which may be
    misspelt."""
    options = {n: _checked(value, n) for n, value in given.items() if value is not None}
    for name, knob in _OF_KNOBS.items():
        if name in options and knob != chosen.knob:
            raise ValueError(f"{name} is not for {chosen.name}, which takes {chosen.knob}")
    for name in options:
        if name not in (*_OF_KNOBS, *chosen.takes):
            those = ", ".join(m.name for m in methods() if name in m.takes)
            raise ValueError(
                f"{name} is not for {chosen.name}; it is for {those}"
                if those
                else f"{name} is not for {chosen.name}, nor for any other method"
                f"{hint(name, (chosen.knob, 'rtol', 'atol', *chosen.takes, *beside))}"
            )
    if chosen.knob not in options:
        what = "h in s" if chosen.knob == "step_size" else "a relative tolerance"
        raise ValueError(f"{chosen.knob} is missing; {chosen.name} needs it, {what} above 0")
    return options
