"""A run of a method, or the answer to an accuracy."""

from __future__ import annotations

import math
import warnings
from typing import Any, Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import Floats, floats
from qddot._methods import Method, method as method_named, options_for
from qddot._scene import Scene
from qddot._solution import Counts, Energy, Solution, State
from qddot._system import System


def model_of(
    of: Scene | System,
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    chosen: Method | None = None,
    keep: Sequence[str] = (),
) -> _qddot.Model:
    """What is run: of a scene what is left of it, of a System itself from that start."""
    if isinstance(of, System):
        if keep:
            raise ValueError("keep: it is for scenes; nothing is left out of a System")
        return of._model(q0, v0)
    if not isinstance(of, Scene):
        raise TypeError(f"{type(of).__name__} is neither a qddot.Scene nor a qddot.System")
    for name, value in (("q0", q0), ("v0", v0)):
        if value is not None:
            other = "positions" if name == "q0" else "velocities"
            raise ValueError(f"{name} is for a System; a scene starts as it is drawn, and "
                             f"scene.replace({other}=...) as you like")
    accepts = chosen is not None and "accepts_massless" in chosen.traits
    return of._model(chosen.name if chosen else None, accepts, keep)


def end_of(of: Scene | System, until: float | None) -> float:
    """The time to run to: that asked for, or the scene's own."""
    own = of.until if isinstance(of, Scene) else None
    end = own if until is None else until
    if end is None:
        raise ValueError("until is missing; it is the time to run to in s, above 0")
    if not (math.isfinite(end) and end > 0):
        raise ValueError(f"until {end} is not allowed; it is the time to run to in s, above 0")
    return float(end)


def require_measurable(of: Scene | System, what: str) -> None:
    """A sentence for a System that has not what references and answers take."""
    if isinstance(of, System) and not (of.has_potential and of.has_stiffness):
        missing = "a potential" if not of.has_potential else "a stiffness, or a pattern of it"
        raise ValueError(f"{what}: the System has no V and K, of which its reference is made; give "
                         f"it {missing}" if not of.has_potential else
                         f"{what}: the System has no K, which its reference takes; give it {missing}")


def solve(
    of: Scene | System,
    method: str | None = None,
    *,
    until: float | None = None,
    step_size: float | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    accuracy: float | None = None,
    accuracy_of: str = "positions",
    save_at: ArrayLike | None = None,
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    keep: Sequence[str] = (),
    seconds: float | None = None,
    threads: int = 1,
    max_order: int | None = None,
    stability_detection: bool | None = None,
    iterations: int | None = None,
    solve_tolerance: float | None = None,
    spectral_radius: float | None = None,
    solver: str | None = None,
    compensated: bool | None = None,
) -> Solution:
    """The motion of a scene, or of a System from q0 and v0 (at rest where not given), up to `until`.

    Either by a method at its knob, step_size [s] or rtol (and atol; by default rtol times the
    scene's own sizes); or, with `accuracy`, a relative error of the positions at the end ("path": at
    all times, "energy"), by whatever method takes the least time for it, with its error bounded.

    save_at: times [s], ascending, from 0 to `until`, at which q and v are returned; the end alone
    where not given. Methods of fixed steps take the same steps with it and without; SUNDIALS' adaptive
    ones land on these times. `seconds`: the run is stopped after so many. `keep`: reductions that are
    not made. The other options are for the methods that name them (Method.takes).

    The GIL is free meanwhile, and Ctrl-C stops the run. A run that fails is a Solution with an
    outcome. Raises ValueError, in a sentence, for what cannot be asked for; and what a callable of a
    System raises.
    """
    given = dict(
        step_size=step_size, rtol=rtol, atol=atol, max_order=max_order, iterations=iterations,
        stability_detection=stability_detection, solve_tolerance=solve_tolerance,
        spectral_radius=spectral_radius, solver=solver, compensated=compensated,
    )
    end = end_of(of, until)
    times = _times(save_at, end)
    if not threads >= 1:
        raise ValueError(f"threads {threads} is not allowed; it is 1 or more")
    if seconds is not None and not seconds > 0:
        raise ValueError(f"seconds {seconds} is not allowed; it is above 0")
    if (method is None) == (accuracy is None):
        raise ValueError("solve takes a method, or an accuracy that it finds one for: one of both")
    if accuracy is not None:
        superfluous = [name for name, value in given.items() if value is not None]
        if superfluous:
            raise ValueError(f"{superfluous[0]} is not for accuracy, which chooses the method and "
                             "its knob: leave out one of both")
        require_measurable(of, "accuracy")
        model = model_of(of, q0, v0, None, keep)
        return _answer(of, model, end, times, accuracy, accuracy_of, seconds, threads)
    assert method is not None
    chosen = method_named(method)
    options = options_for(chosen, given)
    model = model_of(of, q0, v0, chosen, keep)
    return _run(of, model, chosen, options, end, times, seconds, threads)


def _times(save_at: ArrayLike | None, end: float) -> list[float]:
    if save_at is None:
        return [end]
    times = floats(save_at, "save_at", one=True).reshape(-1)
    if times.size and not (np.all(np.diff(times) >= 0) and times[0] >= 0 and times[-1] <= end):
        raise ValueError(f"save_at: its times must ascend from 0 to until = {end:g} s")
    return [float(t) for t in times]


def _run(
    of: Scene | System, model: _qddot.Model, chosen: Method, options: dict[str, Any], end: float,
    times: list[float], seconds: float | None, threads: int,
) -> Solution:
    shape = (model.nodes, model.dimension)
    motion = np.empty((2, len(times), *shape))
    energies = np.empty((3, len(times))) if model.has_potential else None
    record = _qddot.run(model, chosen.name, options, end, times, motion, energies, seconds, threads)
    if record["growth"] and record["summary"]["outcome"] == "reached_end":
        warnings.warn(record["growth"], RuntimeWarning, stacklevel=3)
    seen = record["seen"]
    return _solution(of, record, chosen.name, chosen.knob, options[chosen.knob], times[:seen],
                     motion[:, :seen], None if energies is None else energies[:, :seen],
                     State(**record["end"]), _diagnosis(model, chosen, options, end), {})


def _diagnosis(
    model: _qddot.Model, chosen: Method, options: dict[str, Any], end: float
) -> Callable[[float], str]:
    return lambda wait: _qddot.why_it_failed(model, chosen.name, options, end, wait)


def _solution(
    of: Scene | System, record: dict[str, Any], method: str, knob: str, value: float,
    times: list[float], motion: Floats, energies: Floats | None, end: State,
    diagnose: Callable[[float], str] | None, about: dict[str, Any],
) -> Solution:
    if isinstance(of, System) and of.dimension is None:  # which has unknowns, and no nodes
        motion = motion.reshape(2, len(times), -1)
        end = State(end.t, end.q.reshape(-1), end.v.reshape(-1))
    summary = record["summary"]
    return Solution(
        method=method,
        knob=knob,
        value=float(value),
        t=np.array(times, dtype=float),
        q=motion[0],
        v=motion[1],
        energy=None if energies is None else Energy(*energies),
        end=end,
        outcome=summary["outcome"],
        message=record.get("why") or summary["message"],
        t_reached=summary["t_reached"],
        counts=Counts(**summary["counts"]),
        seconds=record["seconds"],
        energy_growth=summary["energy_growth"],
        _diagnose=diagnose,
        **about,
    )


def _answer(
    of: Scene | System, model: _qddot.Model, end: float, times: list[float], accuracy: float,
    accuracy_of: str, seconds: float | None, threads: int,
) -> Solution:
    record = _qddot.answer(model, end, float(accuracy), accuracy_of, seconds, threads)
    about = dict(
        accuracy=float(accuracy),
        is_reached=record["is_reached"],
        error_estimate=record["error_estimate"],
        error_estimate_kind=record["error_estimate_kind"],
        horizon=record["horizon"],
        runs=record["runs"],
        seconds_in_all=record["seconds_in_all"],
    )
    if "method" not in record:  # no run was begun
        empty = np.empty((2, 0, model.nodes, model.dimension))
        start = State(0.0, *model.nodes_at(model.q, model.v, 0.0))
        return _solution(of, record, "", "", math.nan, [], empty, None, start, None, about)
    chosen = method_named(record["method"])
    options = {chosen.knob: record["value"]}
    if times == [end] and record["is_reached"]:
        state = record["end"]
        motion = np.stack((state["q"], state["v"]))[:, None]
        energies = np.array(record["energies"])[:, None] if model.has_potential else None
        return _solution(of, record, chosen.name, chosen.knob, record["value"], times, motion,
                         energies, State(**state), _diagnosis(model, chosen, options, end), about)
    # The chosen run once more, seen on its way; it ends at the same place but for methods that land
    # on the times.
    run = _run(of, model, chosen, options, end, times, None, threads)
    changes = {**run.__dict__, **about, "seconds": record["seconds"]}
    if record["why"]:
        changes["message"] = record["why"]
    return Solution(**changes)
