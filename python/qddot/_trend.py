"""Where the energy goes in a long run."""

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
    """The energy error of a run over time, taken apart.

    error: (E(t) - E(0)) over the motion's largest kinetic energy, at times t. verdict: "bounded",
    "drifts", "dissipates", "grows", "widens", "round_off", "blows_up", "undecided" or "unknown";
    words says it with numbers. drift [1/s] is (value, low, high), low and high its 95 % interval, of
    the fitted line; oscillation is half of what 95 % of the errors span about it.
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
    """Runs the method on a scene up to `until` [s], for so many seconds at most, and says whether its
    energy error stays bounded, drifts, is dissipated or blows up. Options as in solve()."""
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
