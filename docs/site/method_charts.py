"""A method's place on the charts: how long it takes to each accuracy beside the fastest method.

A chart that is not measured has no runs.
"""

import functools
import itertools
from dataclasses import dataclass

import chart_data
import page_data

CHARTS = ("cloth", "chain", "framed_cloth", "pendulum", "lattice", "fpu", "stiff_frame")
ACCURACIES = tuple(10.0**-digit for digit in range(1, 9))
# A method that takes at most so many times as long as the fastest one is near it.
NEAR = 1.5


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


def time_to(method, chart, accuracy):
    """Its time in s and how many times that of the fastest method; None where it is not reached."""
    times = fastest_of(chart)[accuracy]
    own = times.get(method)
    return None if own is None else (own, own / next(iter(times.values())))


def failures(method, chart):
    """Why its runs failed, each reason with how many."""
    causes = {}
    for run in runs_of(chart).get(method, ()):
        if run.failure:
            causes[run.failure] = causes.get(run.failure, 0) + 1
    return causes


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


def place(method, chart):
    """The method's place on a chart."""
    own = {a: time_to(method, chart, a) for a in ACCURACIES if fastest_of(chart)[a]}
    return Place(
        chart,
        fastest=[a for a, time in own.items() if time and time[1] == 1],
        near=[a for a, time in own.items() if time and 1 < time[1] <= NEAR],
        missed=[a for a, time in own.items() if not time],
        reached=len(own),
    )


def wins(method):
    """The rows of the study of many scenes where it is the fastest, or the next one and near."""
    if not is_measured("many_scenes"):
        return []
    return [
        row
        for row in page_data.rows("many_scenes", "fastest.csv")
        if row["method"] == method or (row["runner_up"] == method and float(row["margin"]) <= NEAR)
    ]


def ranges(accuracies):
    """Accuracies in words, neighbours together: 1e-1 to 1e-3, 1e-6; a dash for none."""
    words = []
    places = sorted(ACCURACIES.index(accuracy) for accuracy in accuracies)
    for _, group in itertools.groupby(enumerate(places), lambda pair: pair[1] - pair[0]):
        own = [page_data.accuracy(ACCURACIES[place]) for _, place in group]
        words.append(own[0] if len(own) == 1 else f"{own[0]} to {own[-1]}")
    return ", ".join(words) or "–"


def example(method):
    """Its fastest run to 1e-3 on the cloth, or the framed one, else its most accurate one there;
    None where it has none."""
    for chart in ("cloth", "framed_cloth"):
        good = [run for run in runs_of(chart).get(method, ()) if not run.failure]
        if good:
            to_it = (run for run in chart_data.ranked(chart, 1e-3) if run.method == method)
            return next(to_it, None) or min(good, key=lambda run: run.at_most)
    return None


def work(run):
    """The forces and the linear solves of a run, for each of its steps."""
    rows = page_data.rows(run.scene, "points.csv", method=run.method, value=run.value)
    row = next(row for row in rows if row["outcome"] == run.outcome)
    return [float(row[what]) / float(row["steps"]) for what in ("force_evaluations", "solves")]
