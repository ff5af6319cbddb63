"""The energy that stiff springs exchange."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

from qddot import _qddot
from qddot._arrays import Floats, number
from qddot._methods import method as method_named
from qddot._scene import Scene
from qddot._starts import end_of, seconds_of


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
    return Exchange(
        made["omega"], made["certified"], _run(made["reference"]), [_run(r) for r in made["runs"]]
    )


def _run(record: dict[str, Any]) -> ExchangeRun:
    record["outcome"] = record.pop("summary")["outcome"]
    for name in ("exchange_error", "tempo", "misfit"):
        record.setdefault(name, None)
    return ExchangeRun(**record)
