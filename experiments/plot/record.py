"""Reads the record of a work-precision study: the runs of points.csv, each with its errors as
chart.json judges them."""

import json
import math
import os
from dataclasses import dataclass
from functools import cached_property

from measurements import BadInput, grouped, parse, read_header, read_rows
from style import number


@dataclass(frozen=True)
class Quantity:
    """One kind of error in words; the title goes on with T. `has_front`: whether a method may be
    chosen by it."""

    title: str
    axis: str
    subtitle: str
    has_front: bool = False


QUANTITIES = {
    "position": Quantity(
        "its error at",
        "relative position error",
        "position error at t = T: max over nodes, divided by the largest displacement",
        has_front=True,
    ),
    "energy": Quantity(
        "its energy error up to",
        "relative energy error",
        "energy error on the way: the largest |E(t) − E(0)| at random times, divided by the largest"
        " kinetic energy",
        has_front=True,
    ),
    "momentum": Quantity(
        "its momentum error up to",
        "relative momentum error",
        "momentum error on the way: largest change of the conserved linear and angular momentum",
    ),
    "modes": Quantity(
        "its modal shares' error up to",
        "total variation distance",
        "kinetic energy over the natural modes, mean over t > T/2: distance of the distribution to"
        " the reference's, 0 to 1",
    ),
}


@dataclass(frozen=True)
class Run:
    """One method at one value of its knob, with one of its errors; error and time are NaN where they
    were not measured.

    knob_words: the knob with its value; solves: how many linear systems it solved; counts_at: the
    error at which the run counts, which is a finer run's where its own is small by luck; failure:
    why it is no point of the picture, empty for a good run.
    """

    scene: str
    method: str
    family: str
    stock_of: str
    knob: str
    value: float
    outcome: str
    time: float
    solves: float
    knob_words: str
    error: float
    at_least: float
    at_most: float
    counts_at: float
    is_lucky: bool
    counts: bool
    is_uncertain: bool
    failure: str


@dataclass(frozen=True)
class FrontPoint:
    """The fastest run whose error is at most the accuracy."""

    accuracy: float
    method: str
    time: float


@dataclass(frozen=True)
class View:
    """The runs of a study by one of their errors.

    front: its points from coarse to fine; none where no method may be chosen by this error.
    ranked: by accuracy, 1e-1, ... 1e-9, the fastest run of each method, the fastest first.
    staircase: the runs that no run beats in both time and error, from coarse to fine.
    floor: the least error that means anything, with its words; None where there is no such limit.
    chaotic_below: the error below which rounding decides.
    """

    column: str
    quantity: Quantity
    subtitle: str
    runs: list
    front: list
    ranked: dict
    staircase: list
    floor: float | None = None
    floor_words: str = ""
    chaotic_below: float | None = None

    @cached_property
    def smallest(self):
        """The least error that is drawn: one below the floor is not known to be that small."""
        measured = [run.error for run in self.runs if not run.failure and run.error > 0]
        return self.floor or min(measured, default=1e-16)

    def drawn_error(self, run):
        """The error at which a run is drawn: one below the floor stands on it."""
        return max(run.error, self.smallest)


@dataclass(frozen=True)
class Record:
    """The facts of a study: its scene, its end [s] (None where unknown), and the one of its `views`
    by which accuracy is judged. `caveats` are for a reader to know before the errors; `rows` are
    those of the judged front, as chart.json has them."""

    scene: str
    until: float | None
    judged_by: str
    views: dict
    caveats: list
    rows: list

    @property
    def judged(self):
        """The view that accuracy is judged by."""
        return self.views[self.judged_by]

    @property
    def is_beyond_horizon(self):
        """Whether the end is beyond the horizon of a chaotic motion."""
        return self.judged_by == "energy"


def lengths(displacements):
    """What belongs to the subtitle of the position error: the least and the largest length [m] that
    errors of the scene's parts are divided by."""
    if not displacements:
        return ""
    least, largest = displacements
    if least == largest:
        return f", {number(largest)} m"
    return f" in the node's own part, {number(least)} to {number(largest)} m"


def facts_of_runs(path):
    """What points.csv says of each run but for its errors: the first fields of Run."""
    texts = ("scene", "method", "knob", "outcome")
    has_solves = "solves" in read_header(path)
    facts = []
    for line, row in read_rows(path, (*texts, "value", "time_s")):
        if not all(row[name] for name in ("method", "knob", "outcome")):
            raise BadInput(f"{path}, line {line}: method, knob and outcome must not be empty.")
        facts.append(
            (
                row["scene"],
                row["method"],
                row.get("family") or "",
                row.get("stock_of") or "",
                row["knob"],
                parse(path, line, row, "value", True),
                row["outcome"],
                parse(path, line, row, "time_s", False),
                parse(path, line, row, "solves", False) if has_solves else 0.0,
            )
        )
    return facts


def view_of(chart, entry, facts):
    """The view of one of the entries of chart.json's quantities."""
    quantity = QUANTITIES[entry["name"]]
    is_judge = entry["name"] == chart["judged_by"]
    # Without these columns, as of before there were any, each run counts at its own error.
    entry = {"counts_at": entry["at_most"], "is_lucky": [False] * len(facts)} | entry
    errors = (map(known, entry[name]) for name in ("errors", "at_least", "at_most"))
    counts_at = [math.inf if error is None else error for error in entry["counts_at"]]
    words = (entry[name] for name in ("is_lucky", "counts", "is_uncertain", "failures"))
    lists = zip(facts, chart["knobs"], *errors, counts_at, *words, strict=True)
    runs = [Run(*own, *judged) for own, *judged in lists]
    fastest = [
        FrontPoint(row["accuracy"], runs[row["point"]].method, runs[row["point"]].time)
        for row in (chart["rows"] if is_judge else entry["front"])
        if row["point"] is not None and quantity.has_front
    ]
    is_position = entry["name"] == "position"
    return View(
        entry["column"],
        quantity,
        quantity.subtitle + (lengths(chart["displacements"]) if is_position else ""),
        runs,
        fastest,
        {row["accuracy"]: [runs[index] for index in row["ranked"]] for row in entry["front"]},
        [runs[index] for index in entry["staircase"]],
        entry["floor"],
        entry["floor_words"],
        entry["rounding_decides_below"],
    )


def known(value):
    """A number of chart.json; NaN where it is null."""
    return math.nan if value is None else value


def read_record(directory):
    """The record of the study in a folder. Raises BadInput where points.csv or chart.json is missing
    or broken, or they are not of one study."""
    facts = facts_of_runs(os.path.join(directory, "points.csv"))
    path = os.path.join(directory, "chart.json")
    try:
        with open(path, encoding="utf-8") as file:
            chart = json.load(file)
        return Record(
            chart["scene"] or os.path.basename(os.path.abspath(directory)),
            chart["until"] or None,
            chart["judged_by"],
            {entry["name"]: view_of(chart, entry, facts) for entry in chart["quantities"]},
            chart["caveats"],
            chart["rows"],
        )
    except FileNotFoundError as error:
        raise BadInput(
            f"{path} is missing: work_precision --judge {directory} makes it."
        ) from error
    except (OSError, LookupError, ValueError, TypeError, AttributeError) as error:
        raise BadInput(f"{path} cannot be read: {error}.") from error


def sweeps(runs):
    """The runs of each method over each of its knobs, sorted by the value of the knob."""
    groups = grouped(runs, lambda run: (run.method, run.knob)).values()
    return [sorted(group, key=lambda run: run.value) for group in groups]
