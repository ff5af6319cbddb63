"""What became of runs over step size and amplitude: those of methods alike belong together."""

import itertools
import math
from dataclasses import dataclass

from measurements import grouped
from style import COOL, number

# The words and colour of an outcome; others are drawn by their own name.
OUTCOMES = {
    "bounded": ("bounded", "#E6EEE4"),
    "leaked": ("energy leaked", "#9CC8E6"),
    "gained": ("energy gained", "#F3B63C"),
    "diverged": ("diverged: the deeper, the faster", "#B3261E"),
    "newton_failed": ("Newton failed", "#8B5A9F"),
    "indefinite_matrix": ("matrix indefinite", "#2B2B2B"),
    "unconverged": ("too few iterations", "#8A7B1E"),
    "step_too_small": ("step collapsed", "#CC79A7"),
    "over_budget": ("not finished in time", "#FFFFFF"),
}
OTHERS = COOL[::-1]
HOLDS = ("bounded", "leaked", "over_budget")
GROWS = ("gained", "diverged")
# The growth of the amplitude in a step, as a logarithm, where the colour is faintest and deepest.
FAINTEST, SLOWEST, FASTEST = 0.35, 3e-3, 1.0
# Runs nearer than this to the limit are not compared with theory.
AT_LIMIT = 0.999


@dataclass(frozen=True)
class Run:
    """What became of one run; numbers that the file does not have are NaN."""

    method: str
    knob: str
    value: float
    h: float
    h_omega: float
    amplitude: float
    outcome: str
    growth_rate: float
    omega_max: float
    buckling_rate: float

    @property
    def column(self):
        """Where it stands from left to right: by step size, or by tolerance, the finer on the
        left."""
        return round(math.log10(self.h_omega if self.knob == "step_size" else self.value), 6)

    @property
    def depth(self):
        """How deep its colour is."""
        growth = self.growth_rate * self.h
        if self.outcome != "diverged" or not 0 < growth < FASTEST:
            return 1.0
        share = math.log(max(growth, SLOWEST) / SLOWEST) / math.log(FASTEST / SLOWEST)
        return FAINTEST + (1 - FAINTEST) * share


@dataclass(frozen=True)
class Panel:
    """Methods of one limit whose runs all end alike; an unknown limit is NaN."""

    methods: list
    limit: float
    runs: list

    @property
    def is_swept(self):
        """Whether the columns are step sizes."""
        return self.runs[0].knob == "step_size"

    @property
    def holds_to(self):
        """The last column up to which every run holds; None where one of the first column fails. The
        next column has a run that fails, though later ones can hold again."""
        failing = {run.column for run in self.runs if run.outcome not in HOLDS}
        columns = sorted({run.column for run in self.runs})
        held = itertools.takewhile(lambda column: column not in failing, columns)
        return max(held, default=None)

    def is_unforeseen(self, run):
        """Whether its energy grew where linear theory says that it does not."""
        return run.outcome in GROWS and self.is_swept and run.h_omega < AT_LIMIT * self.limit

    @property
    def note(self):
        """The limit by theory, where there is one, and up to where all runs hold, in words."""
        first, last = (f(run.column for run in self.runs) for f in (min, max))
        if self.holds_to is None:
            words = f"one fails at {number(10**first)}"
        elif self.holds_to == last:
            unfinished = all(run.outcome == "over_budget" for run in self.runs)
            words = "not finished" if unfinished else "all hold"
        else:
            words = f"all hold to {number(10**self.holds_to)}"
        if not self.is_swept or not self.limit < math.inf:
            return words
        return f"limit {number(self.limit) if self.limit else 0}, {words}"


def panels_of(runs, limits):
    """The panels in the order of the methods."""
    groups = {}
    for method, own in grouped(runs, lambda run: run.method).items():
        ends = frozenset((run.column, run.amplitude, run.outcome) for run in own)
        key = (own[0].knob, str(limits.get(method)), ends)
        groups.setdefault(key, Panel([], limits.get(method, math.nan), own)).methods.append(method)
    return list(groups.values())


def sections_of(panels):
    """The panels by what linear theory says of them, each group under its heading."""
    kinds = (
        (
            "Linear theory: stable below a limit (dashed)",
            lambda p: p.is_swept and p.limit < math.inf,
        ),
        (
            "Linear theory: stable at every step size; failures here are not linear",
            lambda p: p.is_swept and p.limit == math.inf,
        ),
        ("No linear limit known", lambda p: p.is_swept and math.isnan(p.limit)),
        ("Step sizes chosen by the method itself, at rtol", lambda p: not p.is_swept),
    )
    sections = [(title, [panel for panel in panels if fits(panel)]) for title, fits in kinds]
    return [(title, own) for title, own in sections if own]


def color_of(outcome):
    """The colour of an outcome."""
    if outcome in OUTCOMES:
        return OUTCOMES[outcome][1]
    return OTHERS[sum(map(ord, outcome)) % len(OTHERS)]
