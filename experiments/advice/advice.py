"""Draws how good answers are that were asked for by their accuracy alone.

Call: advice.py DIR. Reads cases.csv and cases.json in DIR and writes advice.png and advice.svg
there.

Three panels show ratios for all cases:
- the error bar over the measured error,
- the time of the chosen run over that of the best run in hindsight,
- the time of everything over that of the best run.
"""

import math
import statistics
from dataclasses import dataclass

from matplotlib.ticker import FixedLocator, NullFormatter

from measurements import parse, read_facts, read_rows
from sheet import Sheet, main
from style import FAINT, GRID, INK

WIDTH, HEIGHT = 14.0, 5.6
SIDE, TOP, BOTTOM, GAP = 0.75, 1.3, 0.75, 0.85
PANELS = 3
# A case by what its fastest method does.
KINDS = {"explicit": "#D55E00", "other": "#0072B2"}
EXPLICIT = (
    "verlet",
    "position_verlet",
    "symmetric",
    "takahashi",
    "blanes",
    "dprkn",
    "rk4",
    "kahan",
)
WORTH_COUNTING = 0.02


@dataclass(frozen=True)
class Case:
    """An answer and the best in hindsight; times in seconds."""

    accuracy: float
    error: float
    certified: float
    bar: float
    best_method: str
    best: float
    run: float
    total: float

    @property
    def color(self):
        """The colour of what was the best."""
        is_explicit = self.best_method.startswith(EXPLICIT)
        return KINDS["explicit" if is_explicit else "other"]


def read_cases(path):
    """The cases that were answered and judged."""
    columns = ("accuracy", "error", "certified", "error_estimate")
    times = ("best_time_s", "run_time_s", "total_time_s")
    texts = ("is_claimed", "left_out", "best_method")
    cases = []
    for line, row in read_rows(path, columns + times + texts):
        if row["is_claimed"] != "1" or row["left_out"] or not row["best_method"]:
            continue
        # An exact answer has no error.
        numbers = [parse(path, line, row, name, False) for name in columns]
        seconds = [parse(path, line, row, name, True) for name in times]
        cases.append(Case(*numbers, row["best_method"], *seconds))
    return cases


def quantile(values, part):
    """The value that this part of them does not exceed."""
    ordered = sorted(values)
    return ordered[min(len(ordered), max(1, math.ceil(part * len(ordered)))) - 1]


def new_axes(sheet, place, title, across, up):
    """The axes of one panel, both logarithmic."""
    width = (WIDTH - 2 * SIDE - (PANELS - 1) * GAP) / PANELS
    left = SIDE + place * (width + GAP)
    axes = sheet.axes(left, TOP, width, HEIGHT - TOP - BOTTOM)
    axes.set_title(title, loc="left", size=11, weight="bold", color=INK)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True)
    return axes


def dots(axes, cases, across, up):
    """A dot a case."""
    for case in cases:
        style = {"s": 22, "color": case.color, "alpha": 0.65, "linewidths": 0, "zorder": 3}
        axes.scatter([across(case)], [up(case)], **style)


def lines(axes, values, of_what=""):
    """Where the median and nine tenths of the values end, drawn and in words."""
    ends = [statistics.median(values), quantile(values, 0.9)]
    for end, dashes in zip(ends, ((6, 2), (2, 2))):
        axes.axhline(end, color=INK, linewidth=1, dashes=dashes, zorder=2)
    words = f"{of_what}median {ends[0]:.3g}, nine in ten below {ends[1]:.3g}"
    axes.text(0.02, 0.97, words, transform=axes.transAxes, va="top", size=9, color=INK)


def set_factors(axes, values):
    """Ticks of a few factors, and room for the words above the dots."""
    low, high = 0.8 * min(0.5, min(values)), max(10, max(values))
    axes.set_ylim(low, high * (high / low) ** 0.12)
    factors = [f for f in (0.5, 1, 2, 3, 5, 10, 30, 100, 1000, 10000) if low <= f <= 1.3 * high]
    axes.yaxis.set_major_locator(FixedLocator(factors))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.yaxis.set_minor_formatter(NullFormatter())


def draw_bars(sheet, cases):
    """The error bar over the error."""
    seen = [c for c in cases if c.error > 0 and c.certified <= 0.1 * c.error]
    axes = new_axes(sheet, 0, "How wide is the error bar?", "error", "error bar / error")
    if not seen:
        return
    dots(axes, seen, lambda c: c.error, lambda c: c.bar / c.error)
    axes.axhspan(1e-3, 1, facecolor=GRID, alpha=0.7, zorder=0.5)
    ratios = [c.bar / c.error for c in seen]
    set_factors(axes, ratios)
    lines(axes, ratios)


def draw_choice(sheet, cases):
    """The chosen run over the best."""
    axes = new_axes(
        sheet, 1, "How near is the chosen run to the best?", "accuracy asked for", "time / best"
    )
    if not cases:
        return
    dots(axes, cases, lambda c: c.accuracy, lambda c: c.run / c.best)
    ratios = [c.run / c.best for c in cases]
    set_factors(axes, ratios)
    lines(axes, ratios)


def draw_total(sheet, cases):
    """Everything over the best."""
    axes = new_axes(
        sheet, 2, "How long does the whole answer take?", "time of the best run in s", "time / best"
    )
    if not cases:
        return
    dots(axes, cases, lambda c: c.best, lambda c: c.total / c.best)
    set_factors(axes, [c.total / c.best for c in cases])
    counted = [c.total / c.best for c in cases if c.best >= WORTH_COUNTING]
    axes.axvline(WORTH_COUNTING, ymax=0.9, color=FAINT, linewidth=1, zorder=1)
    if counted:
        lines(axes, counted, "from 20 ms on: ")


def draw(folder):
    """Draws the picture."""
    origin = read_facts(folder / "cases.json")
    cases = read_cases(folder / "cases.csv")
    sheet = Sheet(WIDTH, HEIGHT)
    title = "Motions asked for by their accuracy: how good are the answers?"
    words = (
        f"{len(cases)} drawn cases, {origin.get('cpu', 'unknown processor')}; dashed: median, "
        "dotted: nine in ten; grey: error bars that did not hold"
    )
    sheet.head(SIDE, (0.32, 15, title), (0.64, 10, words))
    place = SIDE
    for name, color in KINDS.items():
        label = sheet.text(
            place, 0.92, f"● {name} method was the best", size=10, color=color, va="center"
        )
        place += sheet.text_width(label) + 0.4
    draw_bars(sheet, cases)
    draw_choice(sheet, cases)
    draw_total(sheet, cases)
    sheet.save_as(folder, "advice")


if __name__ == "__main__":
    main(draw)
