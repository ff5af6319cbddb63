"""The scene file of a mesh."""

from __future__ import annotations

import os
from typing import Sequence


def mesh_toml(
    path: str,
    numbers: dict[str, float | None],
    pins: Sequence[tuple[Sequence[float], Sequence[float]]],
    gravity: Sequence[float] | None,
    until: float | None,
) -> str:
    """A scene file with that [mesh]."""
    stem = os.path.splitext(os.path.basename(path))[0]
    lines = [f"name = {_quoted(stem)}"]
    if until is not None:
        lines.append(f"until = {float(until)!r}")
    if gravity is not None:
        lines.append(f"gravity = {_list(gravity)}")
    lines += ["[mesh]", f"file = {_quoted(path)}"]
    lines += [f"{name} = {float(x)!r}" for name, x in numbers.items() if x is not None]
    for low, high in pins:
        lines += ["[[mesh.pin]]", f"min = {_list(low)}", f"max = {_list(high)}"]
    return "\n".join(lines) + "\n"


def _list(values: Sequence[float]) -> str:
    return repr([float(x) for x in values])


def _quoted(text: str) -> str:
    special = {"\\": "\\\\", '"': '\\"'}
    escaped = (special.get(c, c if c.isprintable() else f"\\U{ord(c):08x}") for c in text)
    return '"' + "".join(escaped) + '"'
