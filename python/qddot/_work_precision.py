"""Speed against accuracy: the work-precision chart."""

from __future__ import annotations

import csv
import inspect
import json
import math
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from typing import Any, Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from qddot import _qddot
from qddot._arrays import count
from qddot._methods import method as method_named
from qddot._names import knows_its_arguments
from qddot._optional import require_package
from qddot._reference import Reference, made_reference
from qddot._scene import Scene
from qddot._solve import table_with_head
from qddot._starts import end_of, require_measurable, require_offered, seconds_of
from qddot._system import System

_drawing = os.path.join(os.path.dirname(__file__), "drawing")


def save(
    folder: str | os.PathLike[str],
    tables: dict[str, NDArray[Any]],
    record: dict[str, Any],
    scene: str,
    reference: dict[str, Any],
) -> None:
    """Writes each table as a CSV file of its name, the record as chart.json, and reference.json."""
    os.makedirs(folder, exist_ok=True)
    for name, rows in tables.items():
        with open(os.path.join(folder, f"{name}.csv"), "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(rows.dtype.names or ())
            writer.writerows([_cell(value) for value in row.tolist()] for row in rows)
    with open(os.path.join(folder, "chart.json"), "w", encoding="utf-8") as file:
        json.dump(record, file)
    with open(os.path.join(folder, "reference.json"), "w", encoding="utf-8") as file:
        json.dump(_reference(scene, reference), file, indent=1)


def drawn_chart(folder: str, ending: str, everything: bool) -> bytes:
    """The picture, .png or .svg, of the chart whose files are in the folder. Raises ImportError if
    matplotlib is missing."""
    require_package("matplotlib", "charts are drawn by")
    all_of_it = ["--all"] if everything else []
    done = subprocess.run(
        [sys.executable, os.path.join(_drawing, "work_precision.py"), folder, *all_of_it],
        env={
            **os.environ,
            "PYTHONPATH": _drawing,
            "MPLBACKEND": "Agg",
            "QDDOT_SHOWS_ALL": "everything=True",
        },
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        raise RuntimeError(f"the chart cannot be drawn: {done.stderr.strip()[-300:]}")
    with open(os.path.join(folder, f"chart{ending}"), "rb") as drawn:
        return drawn.read()


def _reference(scene: str, record: dict[str, Any]) -> dict[str, Any]:
    certified = record["certified"]
    copied = (
        "until made_by chaotic rounding_effect beyond_horizon lyapunov modal_shares_floor "
        "only_symmetric"
    ).split()
    return {
        "scene": scene,
        **{name: record[name] for name in copied},
        **{f"certified_{name}": certified[name] for name in ("position", "velocity", "energy")},
        "horizon": _finite(record["horizon"]),
        "out_of_symmetry": {"horizon": _finite(record.get("symmetric_until", math.inf))},
        "scales": {"displacement": record["displacement"], "parts": record["parts"]},
    }


def _cell(value: Any) -> Any:
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else ""
    return value


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


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
        columns = zip(view["counts"], view["counts_at"], self.record["times"])
        good = [
            i
            for i, (counts, error, time) in enumerate(columns)
            if counts and error is not None and error <= accuracy and time
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

    @knows_its_arguments
    def draw(self, path: str | os.PathLike[str], *, everything: bool = False) -> None:
        """Draws the chart into a PNG or SVG file; `everything` names every method and shows its
        failed runs. Raises ImportError if matplotlib is missing."""
        ending = os.path.splitext(os.fspath(path))[1].lower()
        if ending not in (".png", ".svg"):
            raise ValueError(f"{os.fspath(path)}: allowed are the endings .png and .svg")
        drawn = self._drawn(ending, everything)
        with open(path, "wb") as file:
            file.write(drawn)

    def _drawn(self, ending: str, everything: bool = False) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            self.save(folder)
            return drawn_chart(folder, ending, everything)

    def __repr__(self) -> str:
        methods = len(set(self.points["method"]))
        return (
            f"<qddot.WorkPrecision {self.scene!r} to {self.reference.until:g} s: "
            f"{len(self.points)} points of {methods} methods>"
        )

    def _repr_png_(self) -> bytes | None:
        drawn: bytes | None = self.__dict__.get("_png")
        if drawn is None:
            try:
                drawn = self._drawn(".png")
            except (ImportError, RuntimeError):
                return None  # the table works without matplotlib, too
            object.__setattr__(self, "_png", drawn)
        return drawn

    def _repr_html_(self) -> str | None:
        if self._repr_png_():  # notebooks would show HTML in its place
            return None
        rows = []
        for row in self.front[self.front["method"] != ""]:
            knob = f"{row['knob']} = {row['value']:.3g}"
            error, time = f"{row['error_position']:.1e}", f"{row['time_s']:.3g} s"
            rows.append((f"{row['accuracy']:.0e}", row["method"], knob, error, time))
        return table_with_head(("accuracy", "take", "at", "error", "time"), rows)


def _table(names: Sequence[str], records: list[dict[str, Any]]) -> NDArray[Any]:
    def kind(name: str) -> tuple[str, str]:
        values = [record[name] for record in records]
        if all(isinstance(value, str) for value in values):
            return name, f"U{max(map(len, values), default=1) or 1}"
        return name, "i8" if all(isinstance(value, int) for value in values) else "f8"

    table = np.empty(len(records), dtype=[kind(name) for name in names])
    for i, record in enumerate(records):
        table[i] = tuple(record[name] for name in names)
    return table


def require_one_argument(function: Callable[..., Any], name: str) -> None:
    """Raises ValueError for a callable that cannot be called with one argument."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # C functions have none
        return
    try:
        signature.bind(None)
    except TypeError:
        raise ValueError(
            f"{name}: it takes {signature}; it is called as {name}(point)"
        ) from None


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


@knows_its_arguments
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
    exact = reference or made_reference(of, end, q0, v0, reference_seconds, "reference_seconds")
    exact.require(of, q0, v0)
    if exact.until != end:
        raise ValueError(f"reference: it is that of {exact.until:g} s, and until is {end:g} s")
    if callable(progress):
        require_one_argument(progress, "progress")
    line = _Progress() if progress is True else None
    see = line if line else progress if callable(progress) else None

    def report(record: dict[str, Any]) -> None:
        assert see is not None
        see(Point(**{name: record[name] for name in Point.__dataclass_fields__}))

    try:
        made = _qddot.work_precision(
            exact._held, list(methods), limit, repeats, report if see else None
        )
    finally:
        if line:
            line.end()
    scene = of.name
    for record in made["points"]:
        record["scene"] = scene
    points = _table(COLUMNS, made["points"])
    chart = json.loads(made["chart"]) | {"scene": scene}
    return WorkPrecision(exact, points, _front(made["points"], chart), scene, chart)


def _front(points: list[dict[str, Any]], chart: dict[str, Any]) -> NDArray[Any]:
    nan = math.nan
    nothing = {"method": "", "knob": "", "value": nan, "error_position": nan, "time_s": nan}
    rows = []
    for row in chart["rows"]:
        best, own, sundials = (
            nothing if row[which] is None else points[row[which]]
            for which in ("point", "hand_written", "sundials")
        )
        rows.append({
            "accuracy": row["accuracy"],
            **{name: best[name] for name in nothing},
            "stability_margin": nan if row["margin"] is None else float(row["margin"]),
            "hand_written": own["method"],
            "hand_written_time_s": own["time_s"],
            "sundials": sundials["method"],
            "sundials_time_s": sundials["time_s"],
        })  # fmt: skip
    return _table(list(rows[0]), rows)
