"""The result of a run."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from html import escape
from typing import Any, Callable, Iterable, Sequence

from qddot._arrays import Floats


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
    """Energies [J] at the times of a solution."""

    kinetic: Floats
    potential: Floats
    total: Floats


@dataclass(frozen=True, eq=False)
class State:
    """Positions [m] and velocities [m/s] of all nodes at time t [s]."""

    t: float
    q: Floats
    v: Floats


@dataclass(frozen=True, repr=False, eq=False)
class Solution:
    """The motion that a method computed, at the times t of `save_at` that it reached (at its end
    alone if none were asked for), and at its end.

    q, v: (times, nodes, dimension), or (times, n) of a System without a dimension; views into one
    buffer. energy is None for a System without a potential. outcome is "reached_end" or the kind of
    failure; message says it in a sentence. seconds is the wall time of the run. If an accuracy was
    asked for: error_estimate bounds the relative error, error_estimate_kind says how the bound was
    made ("compared", "refined", "conserved", "rounding", "none"), is_reached says whether it is at
    most the accuracy, and the motion is unknown from the time horizon [s] on.
    """

    method: str
    knob: str
    value: float
    t: Floats
    q: Floats
    v: Floats
    energy: Energy | None
    end: State
    outcome: str
    message: str
    t_reached: float
    counts: Counts
    seconds: float
    energy_growth: float
    accuracy: float | None = None
    is_reached: bool | None = None
    error_estimate: float | None = None
    error_estimate_kind: str | None = None
    horizon: float | None = None
    runs: int = 1
    seconds_in_all: float | None = None
    _diagnose: Callable[[float], str] | None = field(default=None, repr=False, compare=False)

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
        seconds. If it did not fail, what is wrong with its steps, if anything. Empty if there is
        nothing to say, and for a System without V or K."""
        return self._diagnose(seconds) if self._diagnose else ""

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_diagnose": None}  # it holds a model, which no other process has

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
