"""The model that is run, its start and its end time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import number
from qddot._methods import Method
from qddot._scene import Scene
from qddot._system import System


def model_of(
    of: Scene | System,
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    chosen: Method | None = None,
    keep: Sequence[str] = (),
) -> _qddot.Model:
    """The model that is run: a scene after its reductions, or a System from that start."""
    if isinstance(of, System):
        if keep:
            raise ValueError("keep: it is for scenes; nothing is left out of a System")
        return of._model(q0, v0)
    if not isinstance(of, Scene):
        raise TypeError(f"{type(of).__name__} is neither a qddot.Scene nor a qddot.System")
    for name, value in (("q0", q0), ("v0", v0)):
        if value is not None:
            other = "positions" if name == "q0" else "velocities"
            raise ValueError(
                f"{name} is for a System; a scene starts as it is drawn, and "
                f"scene.replace({other}=...) as you like"
            )
    accepts = chosen is not None and "accepts_massless" in chosen.traits
    return of._model(chosen.name if chosen else None, accepts, keep)


def end_of(of: Scene | System, until: float | None) -> float:
    """The time to run to [s]: the one asked for, or the scene's own."""
    own = of.until if isinstance(of, Scene) else None
    if own is None and until is None:
        raise ValueError("until is missing; it is the time to run to in s, above 0")
    end = number(own if until is None else until, "until")
    if not (math.isfinite(end) and end > 0):
        raise ValueError(f"until {end:g} is not allowed; it is the time to run to in s, above 0")
    return end


def require_measurable(of: Scene | System, what: str) -> None:
    """Raises ValueError for a System without the V and K that references and answers need."""
    if not isinstance(of, System):
        return
    for has, missing in (
        (of.has_potential, "a potential"),
        (of.has_stiffness, "a stiffness, or a " "pattern of it"),
    ):
        if not has:
            raise ValueError(
                f"{what}: a System must have V and K for this; give {of.name!r} {missing}"
            )


def require_offered(of: System, chosen: Method) -> None:
    """Raises ValueError for a method that needs something that the System does not compute."""
    others = {
        "constraints": "rods",
        "split_forces": "stiff springs",
        "discrete_gradient": "the discrete gradient of springs",
        "laplacian": "the matrix of springs of rest length zero",
    }
    for need in chosen.needs:
        if need in others:
            raise ValueError(
                f"{chosen.name} needs {others[need]}, which a System does not offer: "
                "take another method, or a Scene"
            )
    if "constant_stiffness" in chosen.needs and not of.linear:
        raise ValueError(
            f"{chosen.name} needs a K that is the same everywhere: if that of {of.name!r} is, give "
            "it as a matrix, or say linear=True; or take another method"
        )
    if "potential" in chosen.needs and not of.has_potential:
        raise ValueError(
            f"{chosen.name} needs V, whose energy it keeps: give {of.name!r} its potential, or take "
            "another method"
        )
    if "stiffness" in chosen.needs and not of.has_stiffness:
        raise ValueError(
            f"{chosen.name} needs K: give {of.name!r} its stiffness, or a pattern by which it is "
            "made of differences of the force; or take an explicit method"
        )


def seconds_of(value: object, name: str) -> float:
    """A wall time above 0."""
    x = number(value, name)
    if not x > 0:
        raise ValueError(f"{name} {value} is not allowed; it is a number of seconds above 0")
    return x


@dataclass(frozen=True)
class Start:
    """The model that is run, and its start."""

    of: Scene | System
    q0: ArrayLike | None
    v0: ArrayLike | None
    keep: tuple[str, ...]
    # The model of an answer, where it is not that of the scene.
    of_answer: _qddot.Model | None = None

    def __post_init__(self) -> None:
        # A copy: a diagnosis may ask again after the caller's arrays have changed.
        for name in ("q0", "v0"):
            value = getattr(self, name)
            object.__setattr__(self, name, None if value is None else np.array(value))

    def model(self, chosen: Method | None = None) -> _qddot.Model:
        if self.of_answer is not None:
            return self.of_answer
        return model_of(self.of, self.q0, self.v0, chosen, self.keep)
