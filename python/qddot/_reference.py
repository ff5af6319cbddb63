"""Motions that are known to certified digits."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import Floats, floats
from qddot._scene import Scene
from qddot._solve import Solution, State
from qddot._starts import end_of, model_of, require_measurable, seconds_of
from qddot._system import System


@dataclass(frozen=True)
class Errors:
    """Relative errors. Those of positions and velocities are the largest of any node, over the
    largest displacement or speed of its part of the scene. That of the energy is over the largest
    kinetic energy."""

    position: float
    velocity: float
    energy: float = float("nan")


@dataclass(frozen=True, repr=False, eq=False)
class Reference:
    """The motion at the time `until` [s]; `certified` bounds its errors.

    q, v: all nodes. made_by: the two methods that agree. chaotic: whether a rounding of the start
    grows exponentially, as exp(lyapunov t). Positions are unknown from the time `horizon` [s] on.
    """

    until: float
    q: Floats
    v: Floats
    energy: float
    certified: Errors
    made_by: str
    seconds: float
    chaotic: bool
    horizon: float
    lyapunov: float
    beyond_horizon: bool
    divided_by: str
    _held: _qddot.Reference = field(repr=False, compare=False)
    _of: Scene | System = field(repr=False, compare=False)  # its callables are called
    _motion: tuple[Any, ...] = field(repr=False, compare=False)
    _record: dict[str, Any] = field(repr=False, compare=False)

    def __repr__(self) -> str:
        return (
            f"<qddot.Reference at {self.until:g} s, {len(self.q)} nodes: positions certified to "
            f"{self.certified.position:.1e}>"
        )

    def require(self, of: Scene | System, q0: ArrayLike | None, v0: ArrayLike | None) -> None:
        """Raises ValueError if it is the reference of another motion."""
        if self._motion != motion_of(of, q0, v0):
            raise ValueError("reference: it is that of another scene, System or start")

    def errors(self, motion: Solution | State | ArrayLike, v: ArrayLike | None = None) -> Errors:
        """The errors of a solution that ended at `until`, or of any q and v of all nodes at that
        time."""
        state = motion.end if isinstance(motion, Solution) else motion
        if isinstance(state, State):
            if state.t != self.until:
                raise ValueError(
                    f"the motion ends at t = {state.t:g} s, and the reference is that of "
                    f"{self.until:g} s"
                )
            q, v = state.q, state.v
        else:
            q = floats(state, "q")
        for name, array in (("q", q), ("v", v)):
            if array is not None and np.shape(array) != self.q.shape:
                raise ValueError(
                    f"errors: {name} has the shape {np.shape(array)}; allowed is that of all "
                    f"nodes, {self.q.shape}"
                )
        velocities = np.zeros_like(q) if v is None else floats(v, "v")
        position, velocity = self._held.errors(q, velocities)
        return Errors(position, velocity if v is not None else float("nan"))


def reference(
    of: Scene | System,
    until: float | None = None,
    *,
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    seconds: float = 10,
) -> Reference:
    """Makes a certified motion by two unlike methods, in about `seconds` at most. Raises
    NoReference if either never reaches the end."""
    require_measurable(of, "reference")
    end, limit = end_of(of, until), seconds_of(seconds, "seconds")
    model = model_of(of, q0, v0)
    if np.any(model.mass == 0):
        raise ValueError("reference: some unknowns have no mass; all need one above 0")
    return held(of, q0, v0, _qddot.reference(model, end, limit))


def motion_of(of: Scene | System, q0: ArrayLike | None, v0: ArrayLike | None) -> tuple[Any, ...]:
    """All that distinguishes a motion from another."""
    if isinstance(of, Scene):
        return (of.content_hash(),)
    start = (None if x is None else floats(x, "start").tobytes() for x in (q0, v0))
    return (id(of), *start)


def held(
    of: Scene | System, q0: ArrayLike | None, v0: ArrayLike | None, handle: _qddot.Reference
) -> Reference:
    """The same as a dataclass."""
    record, end = handle.record(), handle.end()
    flat = isinstance(of, System) and of.dimension is None
    certified = record["certified"]
    names = (
        "until energy made_by seconds chaotic horizon lyapunov beyond_horizon divided_by"
    ).split()
    return Reference(
        q=end["q"].reshape(-1) if flat else end["q"],
        v=end["v"].reshape(-1) if flat else end["v"],
        certified=Errors(certified["position"], certified["velocity"], certified["energy"]),
        _held=handle,
        _of=of,
        _motion=motion_of(of, q0, v0),
        _record=record,
        **{name: record[name] for name in names},
    )
