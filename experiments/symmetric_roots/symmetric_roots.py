"""Draws what the spurious roots of symmetric multistep formulas trade.

Call: symmetric_roots.py DIR, the folder with roots.csv of the program symmetric_roots; writes
DIR/symmetric_roots.png and DIR/symmetric_roots.svg. A dot is a formula, a colour its number of
steps. The left panel shows the phase error over the limit of h w, the right one the gap between
roots over the same limit. The one below shows the energy error of an orbit over the gap. A line
is the best of all formulas with that limit or a larger one; in the left panel, of those with a
large gap.
"""

import sys
from dataclasses import dataclass

from matplotlib.ticker import FixedLocator

from measurements import read_facts, read_table
from sheet import Sheet, main
from style import COOL, FAINT, GRID, INK, MARKERS, WARM, log_ticks, number

# Two panels above, the third and the key below.
LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT = 0.85, 1.1, 3.55, 4.0
ACROSS, SIDE, DOWN, BELOW = 0.85, 0.2, 0.95, 0.75
WIDTH = LEFT + 2 * PANEL_WIDTH + ACROSS + SIDE
HEIGHT = TOP + 2 * PANEL_HEIGHT + DOWN + BELOW
KEY_ROW, WORDS_ROW = 0.3, 0.2
FONT_SIZE = 9.5
COLORS = {4: COOL[0], 6: WARM[2], 8: COOL[1], 10: WARM[0], 12: WARM[3]}
# How opaque dots are whose roots come near each other, and the others.
NEAR, APART = 0.13, 0.5
# All gaps below it are as good as none.
LEAST_GAP = 0.01
LARGEST_GAP = 2.2

# The axes' words, of two panels each.
LIMIT = "vibrations stay bounded up to hω ="
GAP = "smallest angle between two roots, rad"


@dataclass(frozen=True)
class Formula:
    """A formula: its steps, its name where the registry has it, and what was measured of it."""

    steps: int
    method: str
    limit: float
    phase_error: float
    gap: float
    energy_swing: float

    @property
    def color(self):
        """The colour of all formulas of as many steps."""
        return COLORS[self.steps]

    @property
    def marker(self):
        """That of the registry's formula of as many steps."""
        return MARKERS[self.steps // 2 - 2]


def read_formulas(path):
    """Those of the table that are stable where their phase was measured."""
    names = ("limit", "phase_error", "gap", "energy_swing")
    return [
        Formula(int(row["steps"]), row["method"], *(float(row[name]) for name in names))
        for row in read_table(path)
        if row["gap"]
    ]


def front(formulas, is_better, value):
    """The formulas than which none of a larger limit is better, the largest limit first."""
    best = []
    for formula in sorted(formulas, key=lambda f: -f.limit):
        if not best or is_better(value(formula), value(best[-1])):
            best.append(formula)
    return best


def draw_dots(axes, formulas, apart, across, up):
    """A dot a formula, fainter where its roots come near each other."""
    for alpha, is_apart in ((NEAR, False), (APART, True)):
        chosen = [f for f in formulas if (f.gap >= apart) == is_apart]
        if chosen:
            places = [across(f) for f in chosen], [up(f) for f in chosen]
            style = {"s": 5, "alpha": alpha, "linewidths": 0, "rasterized": True}
            axes.scatter(*places, c=[f.color for f in chosen], zorder=2, **style)


def draw_fronts(axes, formulas, is_better, up):
    """A line a number of steps: the best at each limit."""
    for steps, color in COLORS.items():
        best = front([f for f in formulas if f.steps == steps], is_better, up)
        if best:
            points = [(f.limit, up(f)) for f in best]
            axes.plot(*zip(*points), color="white", linewidth=3.4, zorder=3)
            axes.plot(*zip(*points), color=color, linewidth=1.8, zorder=3.1)


def draw_methods(axes, formulas, across, up):
    """A mark for each of the registry's formulas."""
    for f in formulas:
        if f.method:
            style = {"markeredgecolor": INK, "markeredgewidth": 1.1, "linewidth": 0, "zorder": 5}
            axes.plot(across(f), up(f), f.marker, markersize=8.5, color=f.color, **style)


def name_methods(axes, formulas, across, up):
    """The names of the registry's formulas: below their marks to the right or, where there is no
    room, above them to the left."""
    middle = sum(axes.get_xlim()) / 2
    for f in formulas:
        if f.method:
            x, y = across(f), up(f)
            has_room = x < 1.2 * middle
            box = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.6}
            style = {"size": FONT_SIZE, "va": "center", "zorder": 6, "bbox": box}
            axes.annotate(
                f.method,
                (x, y),
                xytext=(7, -13) if has_room else (-6, 12),
                textcoords="offset points",
                ha="left" if has_room else "right",
                **style,
            )


def draw_key(sheet, formulas, at, apart):
    """What dots and lines are, the colours, and the marks of the registry's formulas."""
    left, top = LEFT + PANEL_WIDTH + ACROSS, TOP + PANEL_HEIGHT + DOWN + 0.1
    words = (
        "A dot is a formula, one force a step.",
        f"Strong dots: no two roots come nearer than {number(apart)} rad up to hω = {at}.",
        "Grey: they do.",
        "Lines: the best at that limit or a larger one; upper left, of strong dots.",
    )
    size = {"size": 10, "va": "center"}
    for sentence in words:
        for line in sheet.filled(sentence.split(" "), PANEL_WIDTH, size=10):
            sheet.text(left, top, line, color=FAINT, **size)
            top += WORDS_ROW
        top += 0.06
    top += 0.1
    for steps, color in COLORS.items():
        named = {f.method: f.marker for f in formulas if f.method and f.steps == steps}
        words = f"order {steps}" + "".join(f": {name}" for name in named)
        axes = sheet.axes(left, top - 0.12, 0.24, 0.24)
        axes.set_axis_off()
        axes.set(xlim=(-1, 1), ylim=(-1, 1))
        axes.plot((-0.95, 0.95), (0, 0), color=color, linewidth=2.2)
        for marker in named.values():
            edge = {"markeredgecolor": INK, "markeredgewidth": 1.1}
            axes.plot(0, 0, marker, markersize=8.5, color=color, **edge)
        sheet.text(left + 0.32, top, words, color=INK, **size)
        top += KEY_ROW


def new_axes(sheet, panel, title, across, up):
    """The axes of a panel with its words."""
    row, column = divmod(panel, 2)
    left, top = LEFT + column * (PANEL_WIDTH + ACROSS), TOP + row * (PANEL_HEIGHT + DOWN)
    axes = sheet.axes(left, top, PANEL_WIDTH, PANEL_HEIGHT)
    axes.grid(True, color=GRID)
    axes.tick_params(length=3, color=FAINT, labelsize=FONT_SIZE)
    axes.set_xlabel(across, fontsize=10)
    axes.set_ylabel(up, fontsize=10)
    axes.set_title(title, fontsize=10.5, loc="left", color=INK)
    return axes


def draw_accuracy(sheet, formulas, at, apart):
    """The phase error over the limit."""
    axes = new_axes(
        sheet, 0, "larger steps cost accuracy …", LIMIT, f"phase error at hω = {at}, relative"
    )
    axes.set_yscale("log")
    log_ticks(axes.yaxis, None)
    coordinates = (lambda f: f.limit, lambda f: f.phase_error)
    draw_dots(axes, formulas, apart, *coordinates)
    well_apart = [f for f in formulas if f.gap >= apart]
    draw_fronts(axes, well_apart, float.__lt__, lambda f: f.phase_error)
    draw_methods(axes, formulas, *coordinates)
    name_methods(axes, formulas, *coordinates)


def draw_distance(sheet, formulas, apart):
    """How far roots stay apart over the limit."""
    axes = new_axes(sheet, 1, "… and bring roots near each other …", LIMIT, GAP)
    axes.axhspan(0, apart, facecolor=GRID, alpha=0.6, zorder=0.5)
    coordinates = (lambda f: f.limit, lambda f: f.gap)
    draw_dots(axes, formulas, apart, *coordinates)
    draw_fronts(axes, formulas, float.__gt__, lambda f: f.gap)
    draw_methods(axes, formulas, *coordinates)
    axes.set_ylim(bottom=0)


def draw_orbit(sheet, formulas, apart):
    """What the energy of an orbit does over how far roots stay apart."""
    title = "… where nonlinear motion makes them grow"
    axes = new_axes(sheet, 2, title, GAP, "energy error on an orbit, of its kinetic energy")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.axvspan(LEAST_GAP, apart, facecolor=GRID, alpha=0.6, zorder=0.5)
    shown = [f for f in formulas if f.gap >= LEAST_GAP]
    coordinates = (lambda f: f.gap, lambda f: f.energy_swing)
    draw_dots(axes, shown, apart, *coordinates)
    draw_methods(axes, shown, *coordinates)
    axes.set_xlim(LEAST_GAP, LARGEST_GAP)
    ended = {"size": FONT_SIZE, "ha": "right", "va": "top", "color": FAINT}
    axes.text(0.95 * LARGEST_GAP, 0.88, "1: ended", **ended)
    log_ticks(axes.yaxis, None)
    log_ticks(axes.xaxis, None, "{:g}".format)
    axes.xaxis.set_major_locator(FixedLocator((0.01, 0.03, 0.1, 0.3, 1)))


def draw(folder):
    """Draws the picture."""
    origin = read_facts(folder / "roots.json")
    formulas = read_formulas(folder / "roots.csv")
    if not formulas:
        sys.exit(f"symmetric_roots.py: {folder} has no formula that is stable at {origin['at']:g}")
    at, apart = number(origin["at"]), origin["well_apart"]
    sheet = Sheet(WIDTH, HEIGHT)
    title = "What the spurious roots of symmetric multistep formulas trade"
    sheet.head(SIDE, (0.3, 14, title))
    sheet.rule(0.55)
    draw_key(sheet, formulas, at, apart)
    draw_accuracy(sheet, formulas, at, apart)
    draw_distance(sheet, formulas, apart)
    draw_orbit(sheet, formulas, apart)
    sheet.save_as(folder, "symmetric_roots")


if __name__ == "__main__":
    main(draw)
