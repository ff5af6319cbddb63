"""What work_precision found on one scene, as the row of a table: the fastest method by accuracy."""

import json
import math
import os
from dataclasses import dataclass

import measurements
from names import shown
from style import seconds

# Kinds of methods and how the names of their methods begin; the others are told by whether they solve
# linear systems.
BEGINNINGS = {
    "Euler and Verlet": ("explicit_euler", "symplectic_euler", "verlet", "position_verlet"),
    "symmetric multistep": ("symmetric",),
    "multirate": ("multirate",),
}
TITLES = {
    "pendulum": "elastic pendulum",
    "cloth": "hanging cloth",
    "lattice": "cantilever block",
    "fpu": "Fermi-Pasta-Ulam",
    "framed_cloth": "cloth, stiff frame",
    "stiff_frame": "cloth, stiffer frame",
}


def kind_of(run):
    """The kind of the method of a run."""
    if run.family == "sundials":
        return "SUNDIALS"
    for kind, beginnings in BEGINNINGS.items():
        if run.method.startswith(beginnings):
            return kind
    return "implicit" if run.solves > 0 else "other explicit"


@dataclass(frozen=True)
class Row:
    """A scene: its title, its size in words, its end [s] and how many steps Verlet takes to it at least
    (None where that is not known); by accuracy, as an exponent (3 for 1e-3), the fastest point and how
    many times as long the best of SUNDIALS takes; the kinds of methods, how many they are, and the
    processor."""

    title: str
    size: str
    until: float
    steps: float | None
    front: dict
    ratios: dict
    kinds: dict
    methods: int
    processor: str

    @property
    def duration(self):
        """The end and the steps to it, in words."""
        if not self.steps:
            return seconds(self.until)
        steps = round(self.steps, 1 - math.floor(math.log10(self.steps)))
        return f"{seconds(self.until)}, {steps:,.0f} steps"

    @property
    def stretches(self):
        """The neighbouring accuracies with one fastest method: (method, first, last exponent)."""
        found = []
        for digit in sorted(self.front):
            method = self.front[digit].method
            if found and found[-1][0] == method and found[-1][2] == digit - 1:
                found[-1] = (method, found[-1][1], digit)
            else:
                found.append((method, digit, digit))
        return found


def by_exponent(front):
    """The points of a front by their accuracies' exponents."""
    return {round(-math.log10(point.accuracy)): point for point in front}


def counted(number, noun):
    """So many of something, in words."""
    return f"{number} {noun}" + ("" if number == 1 else "s")


def read_sidecar(path):
    """What the sidecar of points.csv says: title, size, end, steps and processor of a row."""
    try:
        with open(path, encoding="utf-8") as file:
            about = json.load(file)
        scene, until = about["scene"], float(about["until"])
        step = about["reduced"]["largest_stable_step"]
        return {
            "title": TITLES.get(scene["name"], shown(scene["name"])),
            "size": f"{counted(scene['nodes'], 'node')}, {counted(scene['springs'], 'spring')}",
            "until": until,
            "steps": until / step if step else None,
            "processor": about["cpu"],
        }
    except (OSError, LookupError, ValueError, TypeError, AttributeError) as error:
        raise measurements.BadInput(f"{path} cannot be read: {error}.") from error


def read(directory):
    """The row of the scene whose results are in a folder; raises measurements.BadInput where these are
    not of work_precision."""
    runs = measurements.read_runs(os.path.join(directory, "points.csv"))
    front = by_exponent(measurements.read_front(os.path.join(directory, "front.csv"), runs))
    sundials = [run for run in runs if run.family == "sundials"]
    best = by_exponent(measurements.fastest_at_each_accuracy(sundials))
    return Row(
        **read_sidecar(os.path.join(directory, "points.json")),
        front=front,
        ratios={n: best[n].time / point.time for n, point in front.items() if n in best},
        kinds={run.method: kind_of(run) for run in runs if not run.failure},
        methods=len({run.method for run in runs}),
    )
