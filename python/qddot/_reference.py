"""Motions that are known to certified digits."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import Floats, ascending_times, floats, number
from qddot._names import knows_its_arguments
from qddot._scene import Scene
from qddot._solve import Solution, State
from qddot._starts import end_of, model_of, require_measurable, seconds_of
from qddot._system import System


# The relative difference of two times that are one but for rounding.
SAME_TIME = 1e-12


@dataclass(frozen=True)
class Errors:
    """Relative errors. Those of positions and velocities are the largest of any node, over the
    largest displacement or speed of its part of the scene. That of the energy is over the largest
    kinetic energy."""

    position: float
    velocity: float
    energy: float = float("nan")


@dataclass(frozen=True, repr=False, eq=False)
class ErrorsAlong:
    """Relative errors at the times t [s], divided as those of Errors. `certified` bounds the error
    of the reference's own positions at each; smaller errors mean nothing."""

    t: Floats
    position: Floats
    velocity: Floats
    certified: Floats

    def __repr__(self) -> str:
        if not len(self.t):
            return "<qddot.ErrorsAlong no times>"
        return (
            f"<qddot.ErrorsAlong {len(self.t)} times up to {self.t[-1]:g} s: of positions at most "
            f"{np.max(self.position):.1e}>"
        )


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
            f"<qddot.Reference {self._of.name!r} at {self.until:g} s, {len(self.q)} nodes: "
            f"positions certified to {self.certified.position:.1e}>"
        )

    def require(self, of: Scene | System, q0: ArrayLike | None, v0: ArrayLike | None) -> None:
        """Raises ValueError if it is the reference of another motion."""
        if self._motion != motion_of(of, q0, v0):
            raise ValueError("reference: it is that of another scene, System or start")

    @knows_its_arguments
    def errors(
        self,
        motion: Solution | State | ArrayLike,
        v: ArrayLike | None = None,
        *,
        t: float | None = None,
    ) -> Errors:
        """The errors of a solution that ended at `until`, or of any q and v of all nodes at the time
        t [s], which must be `until`."""
        state = motion.end if isinstance(motion, Solution) else motion
        if isinstance(state, State):
            q, v, t = state.q, state.v, state.t
        else:
            q = floats(state, "q")
        if t is None:
            warnings.warn(
                f"errors: q and v are taken for those at {self.until:g} s; say their time t= [s]",
                RuntimeWarning,
                stacklevel=3,
            )
        elif abs(number(t, "t") - self.until) > SAME_TIME * self.until:
            raise ValueError(
                f"errors: the motion ends at t = {t:.10g} s, and the reference is that of "
                f"{self.until:.10g} s; errors_along() has the errors at other times"
            )
        self._require_shape("q", q, self.q.shape)
        if v is not None:
            self._require_shape("v", v, self.q.shape)
        velocities = np.zeros_like(q) if v is None else floats(v, "v")
        position, velocity = self._held.errors(q, velocities)
        return Errors(position, velocity if v is not None else float("nan"))

    @knows_its_arguments
    def errors_along(
        self,
        motion: Solution | ArrayLike,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        *,
        seconds: float = 60,
    ) -> ErrorsAlong:
        """The errors at all times t of a solution (see save_at of solve()); or at times [s] from 0
        to `until`, ascending, of any q and v (times, nodes, dimension). The reference's motion is
        computed again for that, in `seconds` at most, else NoReference is raised."""
        if isinstance(motion, Solution):
            q, v = motion.q, motion.v
        at = motion.t if isinstance(motion, Solution) else motion
        times = ascending_times(at, "t", self.until)
        if q is None:
            raise ValueError("errors_along: q is missing; it has the positions at all times")
        for name, array in (("q", q), ("v", v)):
            if array is not None:
                self._require_shape(name, array, (len(times), *self.q.shape))
        positions = floats(q, "q")
        velocities = np.zeros_like(positions) if v is None else floats(v, "v")
        limit = seconds_of(seconds, "seconds")
        position, velocity, certified = self._held.errors_along(
            times, positions, velocities, limit
        )
        if v is None:
            velocity = np.full(len(times), np.nan)
        return ErrorsAlong(np.array(times), position, velocity, certified)

    def _require_shape(self, name: str, array: ArrayLike, shape: tuple[int, ...]) -> None:
        if np.shape(array) != shape:
            raise ValueError(
                f"errors: {name} has the shape {np.shape(array)}; allowed is that of all nodes, "
                f"{shape}"
            )


@knows_its_arguments
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
    return made_reference(of, until, q0, v0, seconds, "seconds")


def made_reference(
    of: Scene | System,
    until: float | None,
    q0: ArrayLike | None,
    v0: ArrayLike | None,
    seconds: float,
    argument: str,
) -> Reference:
    """The same; `argument` is the name of the caller's argument that has the seconds."""
    require_measurable(of, "reference")
    end, limit = end_of(of, until), seconds_of(seconds, argument)
    model = model_of(of, q0, v0)
    if np.any(model.mass == 0):
        raise ValueError("reference: some unknowns have no mass; all need one above 0")
    return held(of, q0, v0, _qddot.reference(model, end, limit, argument))


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
