"""What charts say: their runs, the fastest of them at an accuracy, and where one kind of methods
overtakes another."""

import functools
import math
import sys
from dataclasses import dataclass

from page_data import DATA, NOTHING, ROOT, BadPage, record, rows, seconds, small, times

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


def crossing(study, accuracy, fast="implicit", slow="explicit"):
    """The stiffness ratio from which on the fastest method of one kind takes less time than that of
    the other, on a line between the measured ratios in logarithms; nan where it never does. Ratios
    at which neither reaches the accuracy say nothing."""
    at = {}
    for cell in rows(study, "kinds.csv", accuracy=accuracy):
        seconds_of = float(cell["time_s"] or "inf") if cell["method"] else math.inf
        at.setdefault(float(cell["stiffness_ratio"]), {})[cell["kind"]] = seconds_of
    known = [(r, t) for r, t in sorted(at.items()) if min(t[slow], t[fast]) < math.inf]
    ahead = [(r, math.log(t[slow]) - math.log(t[fast])) for r, t in known]
    behind = [i for i, (_, lead) in enumerate(ahead) if not lead > 0]
    last = max(behind, default=-1)
    if last + 1 >= len(ahead):
        return math.nan
    if last < 0:
        return ahead[0][0]
    (low, lead_low), (high, lead_high) = ahead[last : last + 2]
    if not math.isfinite(lead_low) or not math.isfinite(lead_high):
        return high
    share = lead_low / (lead_low - lead_high)
    return low * (high / low) ** share
