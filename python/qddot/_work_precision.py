"""Speed against accuracy: the work-precision chart."""

from __future__ import annotations

import json
import math
import os
import sys
import tempfile
from dataclasses import dataclass, field
from typing import Any, Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from qddot import _qddot
from qddot._chart_files import draw, save
from qddot._arrays import count
from qddot._methods import method as method_named
from qddot._reference import Reference, reference as make_reference
from qddot._scene import Scene
from qddot._starts import end_of, require_measurable, require_offered, seconds_of
from qddot._system import System

_text = ("scene", "method", "knob", "outcome", "family", "stock_of")
_whole = (
    "steps rejected force_evaluations stiffness_evaluations factorizations solves newton_iterations "
    "indefinite_factorizations order_reductions stability_limited_steps timed_runs order"
).split()
# The columns of points.csv, as the program work_precision writes it.
COLUMNS = (
    "scene method knob value outcome t_reached error_position error_velocity error_energy time_s "
    "time_min_s setup_s steps rejected force_evaluations stiffness_evaluations factorizations solves "
    "newton_iterations indefinite_factorizations order_mean order_reductions stability_limited_steps "
    "timed_runs family order error_energy_max error_momentum_max error_modal_shares "
    "error_position_at_least error_position_at_most energy_growth stock_of"
).split()


@dataclass(frozen=True)
class Point:
    """A method at one value of its knob: relative errors and the wall time of a run [s]."""

    method: str
    knob: str
    value: float
    error_position: float
    error_position_at_most: float
    error_velocity: float
    error_energy: float
    time_s: float
    outcome: str


@dataclass(frozen=True, repr=False, eq=False)
class WorkPrecision:
    """Times and errors of every method, from coarse to fine, against a reference.

    points: a structured array with the columns of points.csv, fit for pandas.DataFrame(points).
    front: the fastest point at each accuracy, with the best of each family. record: what all of this
    means, as chart.json has it. A notebook shows the chart, if matplotlib is installed.
    """

    reference: Reference
    points: NDArray[Any] = field(repr=False)
    front: NDArray[Any] = field(repr=False)
    scene: str
    record: dict[str, Any] = field(repr=False)

    def best(self, accuracy: float) -> Point | None:
        """The fastest point that is known to reach the accuracy; None if there is none."""
        judge = self.record["judged_by"]
        [view] = [view for view in self.record["quantities"] if view["name"] == judge]
        columns = zip(view["counts"], view["at_most"], self.record["times"])
        good = [
            i
            for i, (counts, at_most, time) in enumerate(columns)
            if counts and at_most is not None and at_most <= accuracy and time
        ]
        if not good:
            return None
        row = self.points[good[np.argmin(self.points["time_s"][good])]]
        names = Point.__dataclass_fields__
        return Point(**{name: row[name].item() for name in names})

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Writes points.csv, front.csv, chart.json and reference.json into the folder, as the program
        work_precision does. Pictures are drawn from these files."""
        tables = {"points": self.points, "front": self.front}
        save(folder, tables, self.record, self.scene, self.reference._record)

    def draw(self, path: str | os.PathLike[str]) -> None:
        """Draws the chart into a PNG or SVG file. Raises RuntimeError if matplotlib is missing."""
        with tempfile.TemporaryDirectory() as parent:
            folder = os.path.join(parent, "chart")
            self.save(folder)
            draw(folder, path)

    def __repr__(self) -> str:
        methods = len(set(self.points["method"]))
        return (
            f"<qddot.WorkPrecision {self.scene!r} to {self.reference.until:g} s: "
            f"{len(self.points)} points of {methods} methods>"
        )

    def _repr_png_(self) -> bytes | None:
        drawn: bytes | None = self.__dict__.get("_png")
        if drawn is None:
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "chart.png")
                try:
                    self.draw(path)
                except RuntimeError:
                    return None  # the table works without matplotlib, too
                with open(path, "rb") as file:
                    drawn = file.read()
            object.__setattr__(self, "_png", drawn)
        return drawn

    def _repr_html_(self) -> str | None:
        if self._repr_png_():  # notebooks would show HTML in its place
            return None
        head = "".join(f"<th>{name}</th>" for name in ("accuracy", "take", "at", "error", "time"))
        rows = []
        for row in self.front:
            if row["method"]:
                knob = f"{row['knob']} = {row['value']:.3g}"
                cells = (
                    f"{row['accuracy']:.0e}",
                    row["method"],
                    knob,
                    f"{row['error_position']:.1e}",
                    f"{row['time_s']:.3g} s",
                )
                rows.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
        return f"<table><tr>{head}</tr>{''.join(rows)}</table>"


def _table(names: Sequence[str], records: list[dict[str, Any]]) -> NDArray[Any]:
    def kind(name: str) -> tuple[str, str]:
        if name in _text or name.endswith(("hand_written", "sundials", "fastest")):
            longest = max((len(str(record[name])) for record in records), default=1)
            return name, f"U{max(1, longest)}"
        return name, "i8" if name in _whole else "f8"

    table = np.empty(len(records), dtype=[kind(name) for name in names])
    for i, record in enumerate(records):
        table[i] = tuple(record[name] for name in names)
    return table


class _Progress:
    """A line on stderr with the last measured point."""

    def __init__(self) -> None:
        self.shown = 0

    def __call__(self, point: Point) -> None:
        words = f"{point.method} {point.value:.3g}: "
        words += f"{point.error_position:.1e}" if point.outcome == "reached_end" else point.outcome
        sys.stderr.write("\r" + words.ljust(self.shown))
        sys.stderr.flush()
        self.shown = len(words)

    def end(self) -> None:
        sys.stderr.write("\r" + " " * self.shown + "\r")
        sys.stderr.flush()


def work_precision(
    of: Scene | System,
    until: float | None = None,
    methods: Sequence[str] = (),
    *,
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    point_limit: float = 1,
    repeats: int = 5,
    reference: Reference | None = None,
    reference_seconds: float = 10,
    progress: bool | Callable[[Point], None] = False,
) -> WorkPrecision:
    """Measures methods over the values of their knobs; without names, all that can run the scene or
    System.

    A run takes `point_limit` seconds at most and is timed `repeats` times on one thread.
    `reference`: one of the same motion. `progress`: True for a line on stderr, or a callable that
    is called with each point.
    """
    require_measurable(of, "work_precision")
    if isinstance(methods, str):
        raise ValueError(f"methods: {methods!r} is one word; it is a list of names")
    for name in methods:
        chosen = method_named(name)
        if isinstance(of, System):
            require_offered(of, chosen)
    end = end_of(of, until)
    limit, repeats = seconds_of(point_limit, "point_limit"), count(repeats, "repeats", 1, 1000)
    exact = reference or make_reference(of, end, q0=q0, v0=v0, seconds=reference_seconds)
    exact.require(of, q0, v0)
    if exact.until != end:
        raise ValueError(f"reference: it is that of {exact.until:g} s, and until is {end:g} s")
    line = _Progress() if progress is True else None
    see = line if line else progress if callable(progress) else None

    def report(record: dict[str, Any]) -> None:
        assert see is not None
        see(Point(**{name: record[name] for name in Point.__dataclass_fields__}))

    try:
        made = _qddot.work_precision(
            exact._held, list(methods), limit, repeats, {}, report if see else None
        )
    finally:
        if line:
            line.end()
    scene = of.name if isinstance(of, Scene) else "system"
    for record in made["points"]:
        record["scene"] = scene
        record["knob"] = str(record["knob"])
    points = _table(COLUMNS, made["points"])
    chart = json.loads(made["chart"]) | {"scene": scene}
    return WorkPrecision(exact, points, _front(made["points"], chart), scene, chart)


def _front(points: list[dict[str, Any]], chart: dict[str, Any]) -> NDArray[Any]:
    names = (
        "accuracy method knob value error_position time_s stability_margin hand_written "
        "hand_written_time_s sundials sundials_time_s"
    ).split()
    rows = []
    for row in chart["rows"]:
        best, own, sundials = (
            points[row[which]] if row[which] is not None else None
            for which in ("point", "hand_written", "sundials")
        )
        nothing = {
            "method": "",
            "knob": "",
            "value": math.nan,
            "error_position": math.nan,
            "time_s": math.nan,
        }
        best, own, sundials = best or nothing, own or nothing, sundials or nothing
        rows.append(
            {
                "accuracy": row["accuracy"],
                **{name: best[name] for name in nothing},
                "stability_margin": math.nan if row["margin"] is None else row["margin"],
                "hand_written": own["method"],
                "hand_written_time_s": own["time_s"],
                "sundials": sundials["method"],
                "sundials_time_s": sundials["time_s"],
            }
        )
    return _table(names, rows)
