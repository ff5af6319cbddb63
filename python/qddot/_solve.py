"""A run of a method, or the answer to an accuracy; and what either gives."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field, fields, replace
from html import escape
from typing import Any, Callable, Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import Floats, ascending_times, count, floats, number
from qddot._methods import Method, lists_options, method as method_named, options_for, options_in
from qddot._names import knows_its_arguments
from qddot._scene import Scene
from qddot._starts import Start, end_of, require_measurable, require_offered, seconds_of
from qddot._system import System


class RunFailed(RuntimeError):
    """A run that did not reach its end or its accuracy; `solution` has the time it reached and the
    reason."""

    def __init__(self, solution: Solution) -> None:
        super().__init__(solution.message)
        self.solution = solution

    def __reduce__(self) -> tuple[Any, ...]:
        return (RunFailed, (self.solution,))


@dataclass(frozen=True)
class Counts:
    """The work done. Steps are accepted ones; solves are right-hand sides."""

    steps: int
    rejected: int
    force_evaluations: int
    stiffness_evaluations: int
    factorizations: int
    solves: int
    newton_iterations: int
    indefinite_factorizations: int
    order_reductions: int
    stability_limited_steps: int


@dataclass(frozen=True, eq=False)
class Energy:
    """Energies [J] at the times of a solution. total is that of the motion; an exact one keeps it
    together with what damping has taken, supports and loads have given, and springs held when they
    broke: total + dissipated - driven + released."""

    kinetic: Floats
    potential: Floats
    total: Floats
    dissipated: Floats
    driven: Floats
    released: Floats


@dataclass(frozen=True)
class Break:
    """A spring that broke: its number in the scene, the time [s], the strain (l - l0)/l0 there, the
    energy that it held [J], and a bound of the time's error [s] if an accuracy was asked for."""

    t: float
    spring: int
    strain: float
    energy: float
    t_error: float | None = None


@dataclass(frozen=True, eq=False)
class State:
    """Positions [m] and velocities [m/s] of all nodes at time t [s]."""

    t: float
    q: Floats
    v: Floats


@dataclass(frozen=True, repr=False, eq=False)
class Solution:
    """The motion that a method computed, at the times t of `save_at` that it reached (at its end
    alone if none were asked for), and at its end. Called with times, it gives q and v there.

    q, v: (times, nodes, dimension), or (times, n) of a System without a dimension; views into one
    buffer. energy is None for a System without a potential. tensions: (times, springs) [N] of the
    scene's rods, NaN for its springs; None without rods. outcome is "reached_end" or the kind of
    failure; message says it in a sentence. seconds is the wall time of the run. energy_growth and
    energy_loss are 1 and 0 for an exact motion: one plus what it gained on the way, and what it
    had lost at the end, over the energy that the motion can turn into speed. If an accuracy was
    asked for: error_estimate bounds the relative error, error_estimate_kind says how the bound was
    made ("compared", "refined", "conserved", "rounding", "neglected", "none"), is_reached says
    whether it is at most the accuracy, the motion is unknown from the time horizon [s] on, and
    left_out says in a sentence whether rods stood for stiff springs or modes for a small motion
    (keep=["rods", "linear"] forbids it). breaks lists the springs that broke, in time.
    """

    method: str
    knob: str
    value: float
    t: Floats
    q: Floats
    v: Floats
    energy: Energy | None
    tensions: Floats | None
    end: State
    outcome: str
    message: str
    t_reached: float
    counts: Counts
    seconds: float
    energy_growth: float
    energy_loss: float
    breaks: tuple[Break, ...] = ()
    accuracy: float | None = None
    is_reached: bool | None = None
    error_estimate: float | None = None
    error_estimate_kind: str | None = None
    horizon: float | None = None
    left_out: str = ""
    runs: int = 1
    seconds_in_all: float | None = None
    _diagnose: Callable[[float], str] | None = field(default=None, repr=False, compare=False)
    _repeat: Callable[[list[float]], Floats] | None = field(default=None, repr=False, compare=False)

    def __call__(self, t: ArrayLike) -> tuple[Floats, Floats]:
        """q and v at the time t [s], or at several times in any order up to t_reached: (nodes,
        dimension) or (times, nodes, dimension). They are those that save_at gives: the run is
        repeated for each call, so ask for all times at once."""
        if self._repeat is None:
            raise ValueError("no run is known to repeat, as after pickling: solve with save_at")
        asked = floats(t, "t")
        if not np.all((asked >= 0) & (asked <= self.t_reached)):
            raise ValueError(f"t: allowed are times from 0 to t_reached = {self.t_reached!r} s")
        times, place = np.unique(asked, return_inverse=True)
        motion = self._repeat([float(x) for x in times])
        q, v = motion.reshape(2, len(times), *self.end.q.shape)
        if times.size and times[-1] == self.t_reached:
            q[-1], v[-1] = self.end.q, self.end.v
        shape, each = np.shape(t) + self.end.q.shape, place.reshape(-1)
        return q[each].reshape(shape), v[each].reshape(shape)

    @property
    def success(self) -> bool:
        """Whether the run reached its end and, if one was asked for, its accuracy."""
        return self.outcome == "reached_end" and self.is_reached is not False

    def or_raise(self) -> Solution:
        """Returns itself, or raises RunFailed if it is no success."""
        if not self.success:
            raise RunFailed(self)
        return self

    def diagnosis(self, seconds: float = 5) -> str:
        """Why the run failed, and steps or methods that do not fail, found by trying for some
        seconds. If it did not fail, what is wrong with its steps, if anything, or why it lost more
        than a twentieth of its energy. Empty if there is
        nothing to say, and for a System without V or K."""
        return self._diagnose(seconds) if self._diagnose else ""

    def __getstate__(self) -> dict[str, Any]:
        # Both hold a model, which no other process has.
        return {**self.__dict__, "_diagnose": None, "_repeat": None}

    def __repr__(self) -> str:
        words = [f"{self.method} at {self.knob} = {self.value:.4g}: {self.outcome}"]
        words.append(f"t = {self.t_reached:g} s after {self.counts.steps} steps")
        words.append(f"{self.seconds:.3g} s")
        if self.error_estimate is not None:
            words.append(f"error at most {self.error_estimate:.1e}")
        return f"<qddot.Solution {', '.join(words)}>"

    def _repr_html_(self) -> str:
        rows = [("method", self.method), (self.knob, f"{self.value:.6g}")]
        rows += [("outcome", self.outcome), ("t", f"{self.t_reached:g} s")]
        if self.message:
            rows.append(("", self.message))
        if self.error_estimate is not None:
            how = f"{self.error_estimate:.2g} ({self.error_estimate_kind})"
            rows.append(("error at most", how))
        rows.append(("wall time", f"{self.seconds:.3g} s"))
        counts = ((f.name, getattr(self.counts, f.name)) for f in fields(self.counts))
        rows += [(name.replace("_", " "), str(count)) for name, count in counts if count]
        return table(rows)


def table(rows: list[tuple[str, str]]) -> str:
    """Rows of a name and a value as HTML."""
    cells = "".join(
        f"<tr><th style='text-align:left'>{escape(name)}</th>"
        f"<td style='text-align:left'>{escape(value)}</td></tr>"
        for name, value in rows
    )
    return f"<table>{cells}</table>"


def table_with_head(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Rows below the titles of their columns as HTML."""
    titles = "".join(f"<th>{title}</th>" for title in head)
    cells = (f"<tr>{''.join(f'<td>{escape(c)}</td>' for c in row)}</tr>" for row in rows)
    return f"<table><tr>{titles}</tr>{''.join(cells)}</table>"


@knows_its_arguments
@lists_options
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
    """The motion of a scene, or of a System from q0 and v0 (default: at rest), up to `until` [s].

    Give a method and its knob: step_size [s], or rtol (and atol; default: rtol times the scene's
    own sizes). Or give an `accuracy`: the fastest method for it is found, and its error is bounded.
    accuracy_of says of what it is the relative error: "positions" at the end, "path" (positions at
    all times) or "energy".

    save_at: times [s], ascending, from 0 to `until`, at which q and v are returned; without it,
    they are those of the state that was reached. Methods of fixed steps take the same steps with it
    and without; SUNDIALS' adaptive ones end steps at these times. `seconds`: limit of the run's
    wall time. `keep`: reductions to leave out. The other options are for the methods that name them
    (Method.takes).

    The GIL is released during the run, and Ctrl-C stops it. A run that fails returns a Solution
    with an outcome. Raises ValueError, with one sentence, for wrong arguments, and the exceptions
    of a System's callables.
    """
    given = options_in(locals())
    end = end_of(of, until)
    times = None if save_at is None else ascending_times(save_at, "save_at", end)
    threads = count(threads, "threads", 1, 256)
    if seconds is not None:
        seconds = seconds_of(seconds, "seconds")
    if (method is None) == (accuracy is None):
        raise ValueError("solve takes a method, or an accuracy that it finds one for: one of both")
    if accuracy is not None:
        superfluous = [name for name, value in given.items() if value is not None]
        if superfluous:
            raise ValueError(
                f"{superfluous[0]} is not for accuracy, which chooses the method and "
                "its knob: leave out one of both"
            )
        require_measurable(of, "accuracy")
        accuracy = number(accuracy, "accuracy")
        if not isinstance(accuracy_of, str):
            raise ValueError(
                f"accuracy_of: {accuracy_of!r}; allowed are positions, path and energy"
            )
        start = Start(of, q0, v0, tuple(keep))
        answer = _answer(start, end, times, accuracy, accuracy_of, seconds, threads)
        is_late = not answer.success and (answer.seconds_in_all or 0) >= (seconds or math.inf)
        return _stopped_by(seconds, answer) if is_late else answer
    assert method is not None
    chosen = method_named(method)
    options = options_for(chosen, given)
    if isinstance(of, System):
        require_offered(of, chosen)
    run = _run(Start(of, q0, v0, tuple(keep)), chosen, options, end, times, seconds, threads)
    is_late = run.outcome == "over_budget" and seconds is not None
    return _stopped_by(seconds, run) if is_late else run


def _stopped_by(seconds: float | None, solution: Solution) -> Solution:
    return replace(solution, message=f"{solution.message} (seconds = {seconds:g})")


def _run(
    start: Start,
    chosen: Method,
    options: dict[str, Any],
    end: float,
    times: list[float] | None,
    seconds: float | None,
    threads: int,
) -> Solution:
    model = start.model(chosen)
    looks = [] if times is None else times
    motion = np.empty((2, len(looks), model.nodes, model.dimension))
    energies = np.empty((6, len(looks))) if model.has_potential else None
    record = _qddot.run(model, chosen.name, options, end, looks, motion, energies, seconds, threads)
    if record["growth"] and record["summary"]["outcome"] == "reached_end":
        warnings.warn(record["growth"], RuntimeWarning, stacklevel=4)
    state, seen = State(**record["end"]), record["seen"]
    about = dict(
        method=chosen.name,
        knob=chosen.knob,
        value=float(options[chosen.knob]),
        seconds=record["seconds"],
        _diagnose=_diagnosis(start, chosen, options, end),
        _repeat=_repetition(start, chosen, options, end, record["summary"], threads),
    )
    if times is None:
        return _at_end(start.of, record, state, about)
    energy = None if energies is None else Energy(*energies[:, :seen])
    about["tensions"] = record["tensions"]
    return _solution(start.of, record, times[:seen], motion[:, :seen], energy, state, about)


def _diagnosis(
    start: Start, chosen: Method, options: dict[str, Any], end: float
) -> Callable[[float], str]:
    def diagnose(seconds: float) -> str:
        of = start.of
        if isinstance(of, System) and not (of.has_potential and of.has_stiffness):
            return ""  # limits of steps come from K, and energies show where a run went wrong
        return _qddot.why_it_failed(start.model(chosen), chosen.name, options, end, seconds)

    return diagnose


def _repetition(
    start: Start,
    chosen: Method,
    options: dict[str, Any],
    end: float,
    summary: dict[str, Any],
    threads: int,
) -> Callable[[list[float]], Floats]:
    # A run that was stopped would go on; all others end as they did.
    last = summary["t_reached"] if summary["outcome"] == "over_budget" else end

    def repeat(times: list[float]) -> Floats:
        model = start.model(chosen)
        motion = np.empty((2, len(times), model.nodes, model.dimension))
        _qddot.run(model, chosen.name, options, last, times, motion, None, None, threads)
        return motion

    return repeat


def _at_end(
    of: Scene | System, record: dict[str, Any], state: State, about: dict[str, Any]
) -> Solution:
    """The solution that has the state at its end alone."""
    motion = np.stack((state.q, state.v))[:, None]
    energy = None
    if record.get("energies"):
        energy = Energy(*np.array(record["energies"])[:, None])
    about["tensions"] = record.get("end_tensions")
    return _solution(of, record, [state.t], motion, energy, state, about)


def _solution(
    of: Scene | System,
    record: dict[str, Any],
    times: list[float],
    motion: Floats,
    energy: Energy | None,
    end: State,
    about: dict[str, Any],
) -> Solution:
    if isinstance(of, System) and of.dimension is None:  # it has unknowns, and no nodes
        motion = motion.reshape(2, len(times), of.mass.size)
        end = State(end.t, end.q.reshape(-1), end.v.reshape(-1))
    summary = record["summary"]
    return Solution(
        t=np.array(times, dtype=float),
        q=motion[0],
        v=motion[1],
        energy=energy,
        end=end,
        outcome=summary["outcome"],
        message=record.get("why") or summary["message"],
        t_reached=summary["t_reached"],
        counts=Counts(**summary["counts"]),
        energy_growth=summary["energy_growth"],
        energy_loss=summary["energy_loss"],
        breaks=tuple(Break(*one) for one in record.get("breaks", ())),
        **about,
    )


def _answer(
    start: Start,
    end: float,
    times: list[float] | None,
    accuracy: float,
    accuracy_of: str,
    seconds: float | None,
    threads: int,
) -> Solution:
    model = start.model()
    record = _qddot.answer(model, start.keep, end, accuracy, accuracy_of, seconds, threads)
    start = replace(start, of_answer=record.get("model_of_answer"))
    names = "left_out is_reached error_estimate error_estimate_kind horizon runs seconds_in_all seconds"
    about: dict[str, Any] = {name: record[name] for name in names.split()}
    about["accuracy"] = accuracy
    if "method" not in record:  # no run was begun
        state = State(0.0, *model.nodes_at(model.q, model.v, 0.0))
        about.update(method="", knob="", value=math.nan)
        return _at_end(start.of, record, state, about)
    chosen = method_named(record["method"])
    options = {chosen.knob: record["value"]}
    about.update(method=chosen.name, knob=chosen.knob, value=record["value"])
    if times is None:
        about["_diagnose"] = _diagnosis(start, chosen, options, end)
        about["_repeat"] = _repetition(start, chosen, options, end, record["summary"], threads)
        return _at_end(start.of, record, State(**record["end"]), about)
    # Repeats the run that was judged, with its own looks, and records these times. Methods that end
    # steps at the times end in another state, of which nothing is claimed.
    left = None if seconds is None else max(seconds - record["seconds_in_all"], 1e-3)
    looks = np.union1d(times, record["looks"])
    run = _run(start, chosen, options, end, [float(t) for t in looks], left, threads)
    message = record["why"] or run.message
    shown = _with_end(_at(run, times), record)
    return replace(shown, **{**about, "message": message})


def _with_end(run: Solution, record: dict[str, Any]) -> Solution:
    """The solution with the end of the record, also as its sample there."""
    end = State(**record["end"])
    if not np.array_equal(end.q.shape, run.end.q.shape):
        end = State(end.t, end.q.reshape(-1), end.v.reshape(-1))
    if run.t.size == 0 or run.t[-1] != end.t:
        return replace(run, end=end)
    q, v = run.q.copy(), run.v.copy()
    q[-1], v[-1] = end.q, end.v
    energy = run.energy
    if energy and record.get("energies"):
        columns = [getattr(energy, f.name).copy() for f in fields(Energy)]
        for column, value in zip(columns, record["energies"]):
            column[-1] = value
        energy = Energy(*columns)
    tensions = run.tensions
    if tensions is not None:
        tensions = tensions.copy()
        tensions[-1] = record["end_tensions"][0]
    return replace(run, end=end, q=q, v=v, energy=energy, tensions=tensions)


def _at(run: Solution, times: list[float]) -> Solution:
    """The solution at some of its times alone."""
    asked = np.array([t for t in times if t <= run.t_reached])
    rows = np.searchsorted(run.t, asked)
    energy = run.energy and Energy(*(getattr(run.energy, f.name)[rows] for f in fields(Energy)))
    tensions = None if run.tensions is None else run.tensions[rows]
    return replace(
        run, t=run.t[rows], q=run.q[rows], v=run.v[rows], energy=energy, tensions=tensions
    )
