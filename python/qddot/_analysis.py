"""Properties of a scene or a method that need no run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import Floats, count as whole_number, number
from qddot._methods import method as method_named, options_for
from qddot._names import knows_its_arguments
from qddot._scene import Scene
from qddot._starts import model_of
from qddot._system import System, length_of


@dataclass(frozen=True, repr=False, eq=False)
class Equilibrium:
    """A stable equilibrium, downhill from the start: the positions [m] of all nodes, and V there
    [J].

    outcome: "reached", "unbounded" or "not_converged"; message says why in a sentence. residual:
    the largest force [N]. smallest_eigenvalue: that of -K [N/m]. isolated: whether V rises in every
    direction. flat_directions: the number of directions in which V is flat within rounding.
    """

    positions: Floats
    potential: float
    outcome: str
    message: str
    residual: float
    smallest_eigenvalue: float
    isolated: bool
    flat_directions: int
    iterations: int

    def __repr__(self) -> str:
        what = f"V = {self.potential:.6g} J, largest force {self.residual:.1e} N"
        if self.outcome != "reached":
            what = self.message
        return f"<qddot.Equilibrium of {len(self.positions)} nodes, {self.outcome}: {what}>"


@dataclass(frozen=True, repr=False, eq=False)
class Modes:
    """The lowest natural modes about the start, by rank.

    squares: w^2 [1/s^2], below zero where a shape grows. shapes: (modes, nodes, dimension), x with
    x'Mx = 1. zeta: each mode's own damping ratio, NaN where it does not vibrate. omega_max [rad/s]:
    the largest natural frequency. finite: the number of all modes.
    """

    squares: Floats
    shapes: Floats
    zeta: Floats
    omega_max: float
    finite: int

    @property
    def omega(self) -> Floats:
        """w [rad/s], or minus the growth rate [1/s] of a growing mode."""
        rates: Floats = np.copysign(np.sqrt(np.abs(self.squares)), self.squares)
        return rates

    def __repr__(self) -> str:
        few = ", ".join(f"{w:.5g}" for w in self.omega[:5])
        more = ", ..." if len(self.squares) > 5 else ""
        return (
            f"<qddot.Modes {len(self.squares)} of {self.finite}: w = {few}{more} rad/s; "
            f"w_max = {self.omega_max:.5g} rad/s>"
        )


@dataclass(frozen=True)
class LinearStep:
    """The effect of one step of a fixed-step method on a vibration q'' = -w^2 q at h w = h_omega.
    roots: the factors that multiply the motion. spectral_radius: the largest modulus of a root.
    damping_ratio, period_error: the damping ratio and the relative error of the period."""

    h_omega: float
    roots: tuple[complex, ...]
    spectral_radius: float
    damping_ratio: float
    period_error: float


@dataclass(frozen=True)
class StabilityLimit:
    """The largest h w at which no vibration grows with a method, predicted by theory and measured;
    infinite if there is none. step_size is the corresponding h [s] on a scene, if one is given."""

    method: str
    predicted: float
    measured: float
    step_size: float | None = None


@knows_its_arguments
def equilibrium(
    of: Scene | System, q0: ArrayLike | None = None, *, length: float | None = None
) -> Equilibrium:
    """The stable equilibrium downhill from the drawn scene, or from q0 of a System of the size
    `length` [m]; default: the length of the System."""
    if isinstance(of, Scene):
        start = _qddot.model_of(of._handle, None, [])
    else:
        if not of.has_potential:
            raise ValueError(
                "equilibrium: the System has no V, which it goes downhill on; give "
                f"{of.name!r} a potential"
            )
        require_stiffness(of, "equilibrium")
        start = model_of(of, q0)
    size = 1.0
    if isinstance(of, System):
        size = of.length if length is None else length_of(length)
    record = _qddot.equilibrium(start, size)
    if isinstance(of, System) and record["outcome"] == "unbounded":
        record["message"] = (
            f"there is no equilibrium within a million lengths of the start (length = {size:g} m)"
        )
    record["positions"] = _shaped(of, record["positions"])
    return Equilibrium(**record)


@knows_its_arguments
def modes(
    of: Scene | System,
    count: int = 10,
    q0: ArrayLike | None = None,
    *,
    at_equilibrium: bool = False,
) -> Modes:
    """The `count` lowest modes of a scene at its start (or at its equilibrium), or of a System at
    q0. Nodes move in all directions that they have."""
    count = whole_number(count, "count")
    require_stiffness(of, "modes")
    if at_equilibrium:
        if isinstance(of, Scene):
            of = of.replace(starts_at_equilibrium=True)
        else:
            q0 = equilibrium(of, q0).positions
    record = _qddot.modes(model_of(of, q0), count)
    shapes = [_shaped(of, shape) for shape in record["shapes"]]
    record["shapes"] = np.array(shapes)
    return Modes(**record)


def linear_step(method: str, h_omega: float, **options: Any) -> LinearStep:
    """The effect of a step of the method on a vibration at h w; options are those of solve()."""
    chosen = method_named(method)
    given = options_for(chosen, {**options, chosen.knob: 1.0}, ("h_omega",))
    return LinearStep(**_qddot.linear_step(method, number(h_omega, "h_omega"), given))


@knows_its_arguments
def stability_limit(
    method: str, of: Scene | System | None = None, q0: ArrayLike | None = None
) -> StabilityLimit:
    """The method's limit of h w, by theory and found by bisection. step_size is the step h [s] at
    that limit on a scene, or a System at q0, for the largest natural frequency of the start."""
    predicted, measured = _qddot.stability_limit(method_named(method).name)
    step = None
    if of is not None:
        require_stiffness(of, "stability_limit")
        omega = _qddot.largest_frequency(model_of(of, q0))
        step = predicted / omega if omega > 0 else np.inf
    return StabilityLimit(method, predicted, measured, step)


def require_stiffness(of: Scene | System, what: str) -> None:
    """Raises ValueError for a System without K."""
    if isinstance(of, System) and not of.has_stiffness:
        raise ValueError(
            f"{what}: the System has no K; give {of.name!r} its stiffness, or a pattern of it"
        )


def _shaped(of: Scene | System, nodes: Floats) -> Floats:
    return nodes.reshape(-1) if isinstance(of, System) and of.dimension is None else nodes
