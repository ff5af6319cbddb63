"""What a method's page says: from the registry (docs/data/methods), its source file, and the studies.

A study without rows of a method gives an empty list or None. The page then says that it is not measured
yet.
"""

import collections
import functools
import itertools
from dataclasses import dataclass

import chart_data
import method_formula
import page_data
from method_formula import escaped

CHARTS = ("cloth", "chain", "framed_cloth", "pendulum", "lattice", "fpu", "stiff_frame")
ACCURACIES = tuple(10.0**-digit for digit in range(1, 9))
# A method that takes at most so many times as long as the fastest one is near it.
NEAR = 1.5
DRIFTS = ("drift_fpu", "drift_orbit", "drift_cloth")
NEEDS = (
    "needs_stiffness",
    "needs_constant_stiffness",
    "needs_split",
    "needs_laplacian",
    "needs_rods",
)
VERDICTS = ("lives", "is damped", "is killed", "blows up")


def is_measured(study):
    """Whether docs/data has the study."""
    return (page_data.DATA / study / "study.json").exists()


@functools.cache
def runs_of(chart):
    """All runs of a chart by method."""
    runs = {}
    for run in chart_data.runs(chart) if is_measured(chart) else ():
        runs.setdefault(run.method, []).append(run)
    return runs


@functools.cache
def fastest_of(chart):
    """For each accuracy the time of each method that reaches it, the fastest first."""
    if not is_measured(chart):
        return {accuracy: {} for accuracy in ACCURACIES}
    return {
        accuracy: {run.method: run.time for run in chart_data.ranked(chart, accuracy)}
        for accuracy in ACCURACIES
    }


def rows_of(study, table, method):
    """The rows of a method; none where the study is not measured."""
    return page_data.rows(study, table, method=method) if is_measured(study) else []


def cell(text):
    """A text for a cell of a table."""
    return escaped(text).replace("|", "\\|")


def ranges(accuracies):
    """Accuracies in words, neighbours together: 1e-1 to 1e-3, 1e-6; a dash for none."""
    words = []
    places = sorted(ACCURACIES.index(accuracy) for accuracy in accuracies)
    for _, group in itertools.groupby(enumerate(places), lambda pair: pair[1] - pair[0]):
        own = [page_data.accuracy(ACCURACIES[place]) for _, place in group]
        words.append(own[0] if len(own) == 1 else f"{own[0]} to {own[-1]}")
    return ", ".join(words) or "–"


@dataclass(frozen=True)
class Place:
    """The accuracies at which a method is the fastest on a chart, near the fastest, and out of reach
    though other methods get there; and how many any method reaches."""

    chart: str
    fastest: list
    near: list
    missed: list
    reached: int

    def words(self, which):
        """The accuracies of one of the lists in words."""
        return ranges(getattr(self, which))


@dataclass(frozen=True)
class Method:
    """An entry of the registry, as simulate --list-methods --newer --csv prints it."""

    name: str
    entry: dict

    def has(self, trait):
        """Whether a column of the registry says yes."""
        return self.entry[trait] == "yes"

    @property
    def order(self):
        """The order of its error; 0 where steps have none."""
        return int(self.entry["order"])

    @property
    def is_fixed(self):
        """Whether its steps have a fixed size."""
        return self.entry["knob"] == "step_size"

    @property
    def lacks_scenes(self):
        """Whether the scenes that do not have it lack what it needs, and it is not just new."""
        has_needs = any(
            self.has(need) for need in ("needs_split", "needs_constant_stiffness", "needs_rods")
        )
        is_new = not self.places and any(self.is_missing(chart) for chart in CHARTS)
        return has_needs and not is_new

    @property
    def kind(self):
        """What kind of method it is, in words; the index has a table for each family and kind."""
        if self.entry["stock_of"]:
            return "stock"
        if self.has("needs_constant_stiffness"):
            return "exact"
        if self.has("needs_rods"):
            return "rods"
        first = "implicit" if self.has("implicit") else "explicit"
        if self.has("needs_split"):
            return f"{first}, stiff springs apart"
        return f"{first}, {'fixed' if self.is_fixed else 'adaptive'} steps"

    @property
    def summary(self):
        """The registry's line as a sentence."""
        line = self.entry["summary"].rstrip(".").replace("w_max", "ω_max")
        if line.split(",")[0] not in {method.name for method in all_methods()}:
            line = line[0].upper() + line[1:]
        return escaped(line) + "."

    @property
    def source(self):
        """The paper."""
        if not self.entry["source"]:
            raise page_data.BadPage(f"method {self.name} has no source in the registry")
        return cell(self.entry["source"])

    @property
    def file(self):
        """The file that defines it."""
        return method_formula.file_of(self.name)

    @property
    def formula(self):
        """Its formula and what its file says of it, as Markdown."""
        return method_formula.formula_of(self.name)

    @property
    def siblings(self):
        """The other methods of its file."""
        known = {method.name for method in all_methods()}
        return [name for name in method_formula.defined_with(self.name) if name in known]

    @property
    def twin(self):
        """The stock way of this method, where there is one."""
        return next((m.name for m in all_methods() if m.entry["stock_of"] == self.name), "")

    @property
    def limit(self):
        """Its row of limits.csv; None where it has none."""
        return next(iter(rows_of("stability_cloth", "limits.csv", self.name)), None)

    @property
    def modes(self):
        """What becomes of the cloth's modes, slow ones first: (first row, last row, how many,
        verdict) of neighbours with one verdict."""
        found = rows_of("stability_cloth", "modal.csv", self.name)
        found.sort(key=lambda row: float(row["h_omega"]))

        def verdict(row):
            words = row["verdict"]  # or WHO in mode N: WHY: ADVICE
            if words in VERDICTS:
                return words
            return "not measured: " + (words.partition(": ")[2].split(": ")[0] or words)

        groups = [(key, list(group)) for key, group in itertools.groupby(found, verdict)]
        return [(own[0], own[-1], len(own), cell(words)) for words, own in groups]

    @property
    def amplitudes(self):
        """What becomes of runs of the pendulum at the least, its own and the largest amplitude:
        (amplitude, rows, the shortest steps first)."""
        found = rows_of("stability_pendulum", "map.csv", self.name)
        found.sort(key=lambda row: float(row["h_omega"]))
        every = sorted({float(row["amplitude"]) for row in found})
        return [
            (a, [row for row in found if float(row["amplitude"]) == a])
            for a in every
            if a in (every[0], 1, every[-1])
        ]

    @property
    def drifts(self):
        """Its rows in the studies of long runs: (scene, row)."""
        return [
            (study.removeprefix("drift_"), row)
            for study in DRIFTS
            for row in rows_of(study, "summary.csv", self.name)
        ]

    @property
    def orders(self):
        """Its rows of order.csv, the longest steps first."""
        return rows_of("convergence", "order.csv", self.name)

    def is_missing(self, chart):
        """Whether a chart has no runs of it, though it has some of another method with its needs."""

        def needs(method):
            return [method.has(need) for need in NEEDS]

        runs = runs_of(chart)
        others = [m for m in all_methods() if needs(m) == needs(self) and m.name in runs]
        return not runs or (self.name not in runs and bool(others))

    def runs(self, chart):
        """All its runs on a chart."""
        return runs_of(chart).get(self.name, [])

    def time(self, chart, accuracy):
        """Its time in s to an accuracy, and how many times that of the fastest method; None where it
        is not reached."""
        times = fastest_of(chart)[accuracy]
        own = times.get(self.name)
        return None if own is None else (own, own / next(iter(times.values())))

    def failures(self, chart):
        """Why its runs failed, each reason with how many."""
        return collections.Counter(run.failure for run in self.runs(chart) if run.failure)

    @property
    def places(self):
        """Its place on each chart that has it."""
        return [self.place(chart) for chart in CHARTS if self.runs(chart)]

    def place(self, chart):
        """Its place on a chart."""
        own = {a: self.time(chart, a) for a in ACCURACIES if fastest_of(chart)[a]}
        return Place(
            chart,
            fastest=[a for a, time in own.items() if time and time[1] == 1],
            near=[a for a, time in own.items() if time and 1 < time[1] <= NEAR],
            missed=[a for a, time in own.items() if not time],
            reached=len(own),
        )

    @property
    def wins(self):
        """The rows of the study of many scenes where it is the fastest, or the next one and near."""
        if not is_measured("many_scenes"):
            return []
        return [
            row
            for row in page_data.rows("many_scenes", "fastest.csv")
            if row["method"] == self.name
            or (row["runner_up"] == self.name and float(row["margin"]) <= NEAR)
        ]

    @property
    def example(self):
        """Its fastest run to 1e-3 on the cloth, or the framed one, else its most accurate one there;
        None where it has none."""
        for chart in ("cloth", "framed_cloth"):
            good = [run for run in self.runs(chart) if not run.failure]
            if good:
                to_it = (run for run in chart_data.ranked(chart, 1e-3) if run.method == self.name)
                return next(to_it, None) or min(good, key=lambda run: run.counts_at)
        return None

    @property
    def work(self):
        """The forces and the linear solves that the example takes for each of its steps."""
        run = self.example
        if not run:
            return None
        rows = page_data.rows(run.scene, "points.csv", method=run.method, value=run.value)
        row = next(row for row in rows if row["outcome"] == run.outcome)
        return [float(row[what]) / float(row["steps"]) for what in ("force_evaluations", "solves")]


@functools.cache
def all_methods():
    """All methods, in the registry's order."""
    return [Method(row["name"], row) for row in page_data.rows("methods", "methods.csv")]
