"""What charts say: their runs, the fastest of them at an accuracy, and at which stiffness ratios one
kind of methods leads."""

import functools
import itertools
import math
import sys
from dataclasses import dataclass

from page_data import DATA, NOTHING, ROOT, BadPage, record, row, rows, seconds, small, times

sys.path.append(str(ROOT / "experiments/plot"))
from record import read_record  # noqa: E402 (the pictures' own reader of work_precision's record)


@dataclass(frozen=True)
class Fastest:
    """The fastest run to an accuracy, or none (then all is a dash); the value of its knob is the step
    size in s, or the relative tolerance."""

    method: str = NOTHING
    time: str = NOTHING
    error: str = NOTHING
    value: str = NOTHING
    seconds: float = math.nan
    knob: str = NOTHING

    def __bool__(self):
        return self.method != NOTHING


@functools.cache
def view(study):
    """What a chart says of its runs by the error that judges them."""
    record(study)
    return read_record(str(DATA / study)).judged


def runs(study):
    """All runs of a chart."""
    return view(study).runs


def methods_on(study):
    """How many methods a chart has: those whose needs its scene meets."""
    return len({run.method for run in runs(study)})


def ranked(study, accuracy):
    """The fastest run of each method that reaches an accuracy on a chart, the fastest first."""
    for known, found in view(study).ranked.items():
        if math.isclose(known, accuracy):
            return found
    raise BadPage(f"the chart of {study} has no fastest method to {accuracy:g}")


def fastest(study, accuracy, of=None, but=()):
    """The fastest run whose error is at most the accuracy. of: a family ("sundials",
    "hand-written"), a method's name, or a list of names; but: names to leave out."""
    names = [of] if isinstance(of, str) else of
    wanted = (
        run
        for run in ranked(study, accuracy)
        if (names is None or run.family in names or run.method in names) and run.method not in but
    )
    for run in wanted:
        words = seconds(run.time), small(run.error), small(run.value)
        return Fastest(run.method, *words, run.time, run.knob)
    return Fastest()


def ratio(slow, fast):
    """How many times as long the first of two fastest runs takes; a dash where one is missing."""
    return times(slow.seconds / fast.seconds) if slow and fast else NOTHING


def kind_at(study, ratio, wanted, kind):
    """The row of the fastest method of a kind."""
    return row(study, "kinds.csv", stiffness_ratio=ratio, accuracy=wanted, kind=kind)


def of_kind(study, ratio, wanted, kind):
    """The fastest method of a kind and its time."""
    cell = kind_at(study, ratio, wanted, kind)
    return f"{seconds(cell['time_s'])} `{cell['method']}`" if cell["method"] else NOTHING


# One kind of methods leads where every other takes at least that many times as long. The times of a
# study that is repeated differ by some per cent, so a smaller lead is nobody's.
CLEAR_LEAD = 1.1


def leaders(study, accuracy, kinds=("explicit", "implicit", "split")):
    """The kind that clearly takes the least time of these at each measured stiffness ratio, the least
    ratio first: {ratio: kind}, or None for a kind where none leads. Ratios at which none of them
    reaches the accuracy say nothing and are left out."""
    times_at = {}
    for cell in rows(study, "kinds.csv", accuracy=accuracy, kind=kinds):
        if cell["method"]:
            own = times_at.setdefault(float(cell["stiffness_ratio"]), {})
            own[cell["kind"]] = float(cell["time_s"])
    found = {}
    for stiffness, own in sorted(times_at.items()):
        first, *others = sorted(own, key=own.get)
        is_clear = all(own[other] >= CLEAR_LEAD * own[first] for other in others)
        found[stiffness] = first if is_clear else None
    return found


def leads_to(study, accuracy, kind, **among):
    """The largest measured ratio up to which a kind leads at each one; None where it does not lead at
    the least."""
    led = itertools.takewhile(lambda at: at[1] == kind, leaders(study, accuracy, **among).items())
    return max((stiffness for stiffness, _ in led), default=None)


def leads_from(study, accuracy, kind, **among):
    """The least measured ratio from which on a kind leads at each one; None where it does not lead at
    the largest."""
    found = reversed(leaders(study, accuracy, **among).items())
    led = itertools.takewhile(lambda at: at[1] == kind, found)
    return min((stiffness for stiffness, _ in led), default=None)


def stiffness_ratio(ratio):
    """A measured ratio as the tables say it."""
    if ratio is None:
        return NOTHING
    return str(int(ratio)) if ratio < 100 else f"{ratio:.0e}".replace("e+0", "e")


def change_of_lead(study, accuracy):
    """The ratio up to which explicit methods lead before implicit ones, and that from which on the
    latter do."""
    both = {"kinds": ["explicit", "implicit"]}
    last = leads_to(study, accuracy, "explicit", **both)
    first = leads_from(study, accuracy, "implicit", **both)
    return f"{stiffness_ratio(last)} / {stiffness_ratio(first)}"


def fastest_at(study, stiffness, accuracy):
    """The fastest method of all at a measured stiffness ratio."""
    return row(study, "crossover.csv", stiffness_ratio=stiffness, accuracy=accuracy)["method"]
