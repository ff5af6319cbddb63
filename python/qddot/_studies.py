"""Studies of methods: their order of convergence, and the energy of long runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import Floats, count, number
from qddot._methods import method as method_named, options_for
from qddot._names import knows_its_arguments
from qddot._reference import Reference, made_reference
from qddot._scene import Scene
from qddot._solve import solve
from qddot._starts import end_of, model_of, require_offered, seconds_of
from qddot._system import System


@dataclass(frozen=True, repr=False, eq=False)
class Convergence:
    """Errors of a method at h, h/2, h/4, ... [s], and the order of each halving: log2 of the ratio
    of errors. An order is NaN if one of its two runs did not reach the end, or if an error is near
    the certified one."""

    method: str
    step_size: Floats
    error_position: Floats
    error_velocity: Floats
    order: Floats

    def __repr__(self) -> str:
        lines = [f"{self.method}: h [s], error of positions, of velocities, order"]
        for h, q, v, p in zip(self.step_size, self.error_position, self.error_velocity, self.order):
            lines.append(f"{h:.3e}  {q:.2e}  {v:.2e}  {p:.2f}")
        return "\n".join(lines)


@knows_its_arguments
def convergence(
    of: Scene | System,
    method: str,
    step_size: float,
    halvings: int = 6,
    *,
    until: float | None = None,
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    reference: Reference | None = None,
    reference_seconds: float = 10,
) -> Convergence:
    """The observed order of convergence of a method of fixed steps, from `step_size` [s] on."""
    exact = reference or made_reference(of, until, q0, v0, reference_seconds, "reference_seconds")
    exact.require(of, q0, v0)
    if until is not None and until != exact.until:
        raise ValueError(f"reference: it is that of {exact.until:g} s, and until is {until:g} s")
    halved = 2.0 ** -np.arange(count(halvings, "halvings") + 1.0)
    steps = np.asarray(number(step_size, "step_size") * halved, dtype=np.float64)
    q, v = np.full(len(steps), np.nan), np.full(len(steps), np.nan)
    for i, h in enumerate(steps):
        solution = solve(of, method, step_size=float(h), until=exact.until, q0=q0, v0=v0)
        if solution.success:
            errors = exact.errors(solution)
            q[i], v[i] = errors.position, errors.velocity
    # An error of twenty times the certified one is wrong by up to 5 %: 0.07 in the order.
    known = np.where(q > 20 * exact.certified.position, q, np.nan)
    order = np.full(len(steps), np.nan)
    order[1:] = np.log2(known[:-1] / known[1:])
    return Convergence(method, steps, q, v, order)


@dataclass(frozen=True, eq=False)
class ExchangeRun:
    """One method at one step size. energies: (times, stiff springs), the oscillatory energy of each
    [J]. tempo: the speed of the exchange over that of the reference. misfit: the remaining
    difference at that tempo. Both are None if the run failed. verdict says it in words."""

    method: str
    step_size: float
    h_omega: float
    t: Floats
    energies: Floats
    sum_deviation: float
    energy_error: float
    exchange_error: float | None
    tempo: float | None
    misfit: float | None
    verdict: str
    outcome: str


@dataclass(frozen=True, eq=False)
class Exchange:
    """How methods exchange the energy of stiff springs. omega [rad/s]: the highest frequency of
    these springs. certified: the error bound of the reference, relative to their energy."""

    omega: float
    certified: float
    reference: ExchangeRun
    runs: list[ExchangeRun]


@knows_its_arguments
def exchange(
    of: Scene,
    methods: Sequence[str],
    h_omega: Sequence[float] = (0.1, 1.0),
    *,
    until: float | None = None,
    every: float | None = None,
) -> Exchange:
    """Follows the energies of the stiff springs (Scene.stiff_above) by each method at each step h,
    given as h w with the springs' highest frequency w. Samples are about `every` [s] apart, by
    default a thousandth of the time."""
    if not isinstance(of, Scene):
        raise TypeError("exchange is for a qddot.Scene, whose springs may be stiff")
    for name in methods:
        method_named(name)
    between = None if every is None else seconds_of(every, "every")
    steps = [number(x, "h_omega") for x in h_omega]
    if not all(0 < x < float("inf") for x in steps):
        raise ValueError("h_omega: its numbers are finite and above 0")
    made = _qddot.exchange(of._model(), list(methods), steps, end_of(of, until), between)
    reference, *runs = (ExchangeRun(**r) for r in (made["reference"], *made["runs"]))
    return Exchange(made["omega"], made["certified"], reference, runs)


@dataclass(frozen=True, repr=False, eq=False)
class EnergyTrend:
    """The energy error of a run over time, separated into drift and oscillation.

    error: (E(t) - E(0)) over the motion's largest kinetic energy, at times t. verdict: "bounded",
    "drifts", "dissipates", "grows", "widens", "round_off", "blows_up", "undecided" or "unknown";
    words says it with numbers. drift [1/s]: (value, low, high), the slope of the fitted line and
    its 95 % interval. oscillation: half the span of 95 % of the errors about the line.
    """

    method: str
    t: Floats
    energy: Floats
    error: Floats
    verdict: str
    words: str
    drift: tuple[float, float, float]
    oscillation: float
    outcome: str
    t_reached: float
    seconds: float

    def __repr__(self) -> str:
        return f"<qddot.EnergyTrend {self.method}: {self.words}>"


def energy_trend(
    of: Scene | System,
    method: str,
    *,
    until: float | None = None,
    step_size: float | None = None,
    rtol: float | None = None,
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    seconds: float = 60,
    **options: Any,
) -> EnergyTrend:
    """Runs the method on a scene, or on a System with a potential from q0 and v0, up to `until`
    [s], for `seconds` of wall time at most. Says whether its energy error stays bounded, drifts or
    blows up, or its energy is dissipated. Options as in solve()."""
    chosen = method_named(method)
    names = ("until", "q0", "v0", "seconds")
    given = options_for(chosen, {"step_size": step_size, "rtol": rtol, **options}, names)
    if isinstance(of, System):
        require_offered(of, chosen)
        if not of.has_potential:
            raise ValueError(
                "energy_trend: the System has no V, whose sum with T is the energy; give "
                f"{of.name!r} a potential"
            )
    model, limit = model_of(of, q0, v0), seconds_of(seconds, "seconds")
    record = _qddot.energy_trend(model, chosen.name, given, end_of(of, until), limit)
    if record["outcome"] == "over_budget":
        record["words"] += f" (seconds = {limit:g})"
    return EnergyTrend(method=chosen.name, **record)
