"""Reads the measurements of one experiment: its runs, its front and its reference solution."""

import csv
import json
import math
from dataclasses import dataclass

# A relative error above this says only that the solution is lost.
WORST_ERROR = 3.0
# The accuracies of a front: 1e-1, ... 1e-9.
DECADES = tuple(10.0**-digit for digit in range(1, 10))


class BadInput(Exception):
    """A measurement file that cannot be read; the message is one sentence."""


@dataclass(frozen=True)
class Run:
    """One method at one value of its knob; error and time are NaN where they were not measured."""

    scene: str
    method: str
    family: str
    stock_of: str
    knob: str
    value: float
    outcome: str
    error: float
    time: float
    # Whether it may be on the front.
    counts: bool = True
    # What the error is at least and at most, where the reference has an error of its own.
    known: tuple | None = None
    # How many linear systems it solved; 0 where the table does not say.
    solves: float = 0.0

    @property
    def is_measured(self):
        """Whether it has an error."""
        return not math.isnan(self.error)

    @property
    def failure(self):
        """Why the run is no point of the picture, in words; empty for a good run."""
        if self.outcome != "reached_end":
            return self.outcome.replace("_", " ").replace("newton", "Newton")
        if not self.is_measured:
            return "error not measured"
        if self.error > WORST_ERROR:
            return f"error above {WORST_ERROR:g}"
        return "" if 0 < self.time < math.inf else "not timed"

    @property
    def bound(self):
        """What the error is at most."""
        return self.known[1] if self.known else self.error

    @property
    def is_uncertain(self):
        """Whether what is not known of the error is a tenth of it or more."""
        return self.bound > 1.1 * self.error


@dataclass(frozen=True)
class FrontPoint:
    """The fastest run whose error is at most the accuracy."""

    accuracy: float
    method: str
    error: float
    time: float


@dataclass(frozen=True)
class Reference:
    """What is known of the reference solution; None where nothing is."""

    scene: str | None
    until: float | None
    certified: float | None
    # The error below which runs differ by roundings alone; None if it is no more than the
    # reference's own.
    chaotic_below: float | None
    # The horizon [s] of a chaotic motion and the rate [1/s] at which runs from nearly the same
    # start part; None if the end is not beyond the horizon.
    horizon: float | None = None
    lyapunov: float | None = None
    # The distance by chance of two distributions of energy.
    modal_floor: float | None = None
    # The time [s] from which a push out of symmetry has moved the nodes apart, if the motion exists
    # in exact symmetry alone.
    symmetric_until: float | None = None
    # The lengths [m] that position errors are divided by: the least and the largest of the scene's
    # parts.
    displacements: tuple | None = None


def read_header(path):
    """The names of a CSV file's columns."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            return next(csv.reader(file), [])
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error
        raise BadInput(f"{path} cannot be read: {reason}.") from error


def read_rows(path, columns):
    """The rows of a CSV file with a header, each with its line number."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            missing = [name for name in columns if name not in (reader.fieldnames or [])]
            if missing:
                raise BadInput(f"{path} has no column {missing[0]}.")
            return [(reader.line_num, row) for row in reader]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error
        raise BadInput(f"{path} cannot be read: {reason}.") from error


def parse(path, line, row, column, required):
    """The number in a cell: NaN for an empty cell, and required ones are positive and finite."""
    text = row[column] or ""
    try:
        value = float(text) if text.strip() else math.nan
    except ValueError as error:
        raise BadInput(f"{path}, line {line}: {column} is {text!r}, not a number.") from error
    if required and not 0 < value < math.inf:
        raise BadInput(f"{path}, line {line}: {column} must be a positive number.")
    return value


def read_runs(path, column="error_position"):
    """All runs in the order of the file, with the error of one column."""
    texts = ("scene", "method", "knob", "outcome")
    bounds = (f"{column}_at_least", f"{column}_at_most")
    header = set(read_header(path))
    runs = []
    for line, row in read_rows(path, (*texts, "value", column, "time_s")):
        if not all(row[name] for name in ("method", "knob", "outcome")):
            raise BadInput(f"{path}, line {line}: method, knob and outcome must not be empty.")
        runs.append(
            Run(
                **{name: row[name] for name in texts},
                family=row.get("family") or "",
                stock_of=row.get("stock_of") or "",
                value=parse(path, line, row, "value", True),
                error=parse(path, line, row, column, False),
                time=parse(path, line, row, "time_s", False),
                known=(
                    tuple(parse(path, line, row, name, False) for name in bounds)
                    if header.issuperset(bounds)
                    else None
                ),
                solves=parse(path, line, row, "solves", False) if "solves" in header else 0.0,
            )
        )
    return runs


def read_front(path, runs):
    """The points of the front, the coarsest accuracy first; accuracies no method reached are left
    out."""
    methods = {run.method for run in runs}
    points = []
    for line, row in read_rows(path, ("accuracy", "method", "error_position", "time_s")):
        if row["method"] and row["method"] not in methods:
            raise BadInput(f"{path}, line {line}: there are no runs of {row['method']}.")
        if row["method"]:
            accuracy = parse(path, line, row, "accuracy", True)
            error = parse(path, line, row, "error_position", False)
            time = parse(path, line, row, "time_s", True)
            if math.isnan(error):
                raise BadInput(f"{path}, line {line}: error_position must not be empty.")
            points.append(FrontPoint(accuracy, row["method"], error, time))
    return sorted(points, key=lambda point: -point.accuracy)


def fastest_at_each_accuracy(runs, accuracies=DECADES):
    """The points of the front at these accuracies."""
    points = []
    for accuracy in accuracies:
        good = [run for run in runs if run.counts and not run.failure and run.bound <= accuracy]
        if good:
            best = min(good, key=lambda run: run.time)
            points.append(FrontPoint(accuracy, best.method, best.error, best.time))
    return points


def displacements(scales):
    """The least and the largest length that position errors of the scene's parts are divided by:
    a part at rest has that of the whole scene."""
    whole = float(scales["displacement"])
    parts = scales.get("parts") or []
    lengths = [whole if part["at_rest"] else float(part["displacement"]) for part in parts]
    return (min(lengths, default=whole), max(lengths, default=whole))


def said_of(path, what):
    """What the sidecar of a table says, None where it says nothing."""
    try:
        with open(f"{path.removesuffix('.csv')}.json", encoding="utf-8") as file:
            return json.load(file).get(what)
    except (OSError, ValueError, AttributeError):
        return None


def interrupted_by(path):
    """What ended the study of the table before it was complete."""
    return said_of(path, "interrupted")


def are_times_of_work(path):
    """Whether the times in a table are counts times costs, which nobody measured."""
    return said_of(path, "times") == "work"


def read_reference(path):
    """What the file says of the reference solution; a file that is not there says nothing."""
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
        until, certified = content.get("until"), content.get("certified_position")
        beyond = bool(content.get("beyond_horizon"))
        return Reference(
            content.get("scene"),
            None if until is None else float(until),
            float(certified) if certified is not None and float(certified) > 0 else None,
            float(content["rounding_effect"]) if content.get("chaotic") else None,
            float(content["horizon"]) if beyond else None,
            float(content["lyapunov"]) if beyond else None,
            float(content["modal_shares_floor"]) if beyond else None,
            float(content["out_of_symmetry"]["horizon"]) if content.get("only_symmetric") else None,
            displacements(content["scales"]) if "scales" in content else None,
        )
    except FileNotFoundError:
        return Reference(None, None, None, None)
    except (OSError, LookupError, ValueError, TypeError, AttributeError) as error:
        raise BadInput(f"{path} cannot be read: {error}.") from error


def sweeps(runs):
    """The runs of each method over each of its knobs, sorted by the value of the knob."""
    groups = {}
    for run in runs:
        groups.setdefault((run.method, run.knob), []).append(run)
    return [sorted(group, key=lambda run: run.value) for group in groups.values()]
