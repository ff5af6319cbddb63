"""Advice on the fastest method for an accuracy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import number
from qddot._names import knows_its_arguments
from qddot._scene import Scene
from qddot._solve import table_with_head
from qddot._starts import end_of, model_of, require_measurable
from qddot._system import System


@dataclass(frozen=True)
class Candidate:
    """A run that might be made, with its expected error and time [s]."""

    method: str
    knob: str
    value: float
    error: float
    seconds: float


@dataclass(frozen=True)
class Advice:
    """The run to take for one accuracy. `take` is None if no run is known to reach it; `why` then
    says the reason. The runner-up takes `margin` times as long. All runs were made, and their
    errors are bounds."""

    accuracy: float
    take: Candidate | None
    why: str
    margin: float
    runner_up: Candidate | None
    own_explicit: Candidate | None
    own_implicit: Candidate | None
    sundials: Candidate | None


@dataclass(frozen=True, repr=False)
class Advices:
    """Advice for each accuracy, and the properties of the scene that decide it: the largest
    frequencies [rad/s] at the start and over the motion, Verlet's largest stable step [s], and the
    horizon [s] of a chaotic motion. It can be indexed and iterated over."""

    for_each: list[Advice]
    w_start: float
    w_motion: float
    own_frequency: float
    largest_stable_step: float
    lyapunov: float
    horizon: float
    runs: int
    seconds: float

    def __len__(self) -> int:
        return len(self.for_each)

    def __iter__(self) -> Iterator[Advice]:
        return iter(self.for_each)

    def __getitem__(self, index: int) -> Advice:
        return self.for_each[index]

    def _rows(self) -> list[tuple[str, ...]]:
        rows: list[tuple[str, ...]] = [
            ("accuracy", "take", "at", "expected error", "expected time", "runner-up")
        ]
        for advice in self.for_each:
            take, other = advice.take, advice.runner_up
            if take is None:
                rows.append((f"{advice.accuracy:.0e}", "-", advice.why, "", "", ""))
                continue
            margin = f"{advice.margin:.2g} x" if math.isfinite(advice.margin) else ""
            rows.append((
                f"{advice.accuracy:.0e}", take.method, f"{take.knob} = {take.value:.3g}",
                f"{take.error:.1e}", f"{take.seconds:.2g} s",
                f"{other.method}, {margin}" if other else "",
            ))  # fmt: skip
        return rows

    def __repr__(self) -> str:
        rows = self._rows()
        widths = [max(map(len, column)) for column in zip(*rows)]
        lines = ("  ".join(c.ljust(w) for c, w in zip(row, widths)).rstrip() for row in rows)
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        head, *rows = self._rows()
        return table_with_head(head, rows)


@knows_its_arguments
def advise(
    of: Scene | System,
    accuracies: float | Sequence[float],
    *,
    until: float | None = None,
    accuracy_of: str = "positions",
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
) -> Advices:
    """Finds the method that reaches each accuracy in the least time. That takes at most half a
    second, or about twice the run that is advised."""
    require_measurable(of, "advise")
    asked = [number(a, "accuracy") for a in np.atleast_1d(np.asarray(accuracies, dtype=object))]
    record = _qddot.advise(model_of(of, q0, v0), end_of(of, until), asked, accuracy_of)
    record["for_each"] = [_advice(one) for one in record["for_each"]]
    return Advices(**record)


def _advice(record: dict[str, Any]) -> Advice:
    for name in ("take", "runner_up", "own_explicit", "own_implicit", "sundials"):
        record[name] = None if record[name] is None else Candidate(**record[name])
    return Advice(**record)
