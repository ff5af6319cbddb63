"""The trend of the energy error in a long run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from qddot import _qddot
from qddot._arrays import Floats
from qddot._methods import method as method_named, options_for
from qddot._scene import Scene
from qddot._starts import end_of, seconds_of


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
    of: Scene,
    method: str,
    *,
    until: float | None = None,
    step_size: float | None = None,
    rtol: float | None = None,
    seconds: float = 60,
    **options: Any,
) -> EnergyTrend:
    """Runs the method on a scene up to `until` [s], for `seconds` of wall time at most. Says
    whether its energy error stays bounded, drifts or blows up, or its energy is dissipated. Options
    as in solve()."""
    if not isinstance(of, Scene):
        raise TypeError("energy_trend is for a qddot.Scene, whose momenta are known")
    chosen = method_named(method)
    given = options_for(chosen, {"step_size": step_size, "rtol": rtol, **options})
    if chosen.knob == "rtol":
        given.pop("step_size", None)
    record = _qddot.energy_trend(
        of._model(), chosen.name, given, end_of(of, until), seconds_of(seconds, "seconds")
    )
    return EnergyTrend(
        method=chosen.name,
        t=record["t"],
        energy=record["energy"],
        error=record["error"],
        verdict=record["verdict"],
        words=record["words"],
        drift=record["trend"]["drift"],
        oscillation=record["trend"]["oscillation"],
        outcome=record["summary"]["outcome"],
        t_reached=record["summary"]["t_reached"],
        seconds=record["seconds"],
    )
