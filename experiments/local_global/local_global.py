"""Draws how much iterations gain in one step of implicit Euler, over their number and their time.

Call: local_global.py DIR, the folder with convergence.csv and positions.csv of the program
local_global; writes DIR/local_global.png and DIR/local_global.svg. The upper panels show the error
of the energy that the step minimises. The lower ones show the distance of positions to the
converged step. A line shows the distance of the converged step to the true motion; iterations below
it do not matter.
"""

from itertools import groupby

from labels import ink_within, label_lines
from measurements import read_facts, read_table
from sheet import Sheet, main
from style import COOL, FRONT, INK, WARM, Family, Look, decades, power_of_ten, seconds

WIDTH, HEIGHT = 11.6, 8.6
LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT = 0.85, 1.2, 5.0, 3.05
ACROSS, DOWN = 0.45, 0.55
FONT_SIZE = 9.5
# Beyond what doubles hold of the energy nothing is drawn.
LEAST_ERROR = 1e-10
LEAST_DISTANCE = 1e-8

# The meaning of the line, over iterations and over time, and the place of these words.
OWN_ERROR = (
    ("yellow: nearer to the\nconverged step than\nthat is to the truth", (0.43, 0.2)),
    (
        "the line is the step's own error:\nsolved to the end, it is still {}\n"
        "from the true motion. Below it,\nmore iterations gain nothing",
        (0.02, 0.03),
    ),
)

CONSTANT = Family("one constant matrix", WARM, "-", True, 1.8)
NEWTON = Family("a new matrix each iteration", COOL, (0, (4, 1.8)), False, 1.8)
SOLVERS = {
    "local_global": ("local/global", Look(WARM[0], "o", CONSTANT)),
    "local_global_chebyshev": ("Chebyshev", Look(WARM[2], "s", CONSTANT)),
    "local_global_anderson": ("Anderson", Look(WARM[3], "^", CONSTANT)),
    "local_global_lbfgs": ("L-BFGS", Look(WARM[1], "D", CONSTANT)),
    "newton_exact": ("Newton", Look(COOL[0], "v", NEWTON)),
    "newton_clamped": ("Newton, K clamped", Look(COOL[1], "P", NEWTON)),
}


def read(path):
    """The rows of a table by solver, without the starts: iterations, seconds and the rest."""
    rows = [row for row in read_table(path) if int(row["iteration"]) > 0]
    return {name: list(own) for name, own in groupby(rows, key=lambda row: row["solver"])}


def curves(table, across, up, least):
    """The points of each solver, up to where it has come to `least`."""
    lines = {}
    for name, rows in table.items():
        errors = [float(row[up]) for row in rows]
        end = next((i + 1 for i, error in enumerate(errors) if error <= least), len(rows))
        points = zip((float(row[across]) for row in rows[:end]), errors)
        lines[name] = [(place, max(error, least)) for place, error in points]
    return lines


def draw_lines(axes, lines):
    """One line a solver, a mark at every few of its points."""
    for name, points in lines.items():
        look = SOLVERS[name][1]
        style = look.marker_style(4.2) | {"markevery": max(1, len(points) // 12)}
        line = {"color": look.color, "linestyle": look.family.line, "linewidth": 1.6}
        axes.plot(*zip(*points), zorder=3, **line, **style)


def draw_own_error(axes, own, words, place):
    """The error of the converged step, below which a solver has nothing to gain; returns the pixels
    of the words."""
    low = axes.get_ylim()[0]
    axes.axhspan(low, own, facecolor=FRONT, alpha=0.22, zorder=0.5)
    axes.axhline(own, color=INK, linewidth=1.4, zorder=2)
    foot = {"ha": "left", "va": "bottom", "transform": axes.transAxes, "zorder": 5}
    text = axes.text(*place, words, size=FONT_SIZE, color=INK, linespacing=1.35, **foot)
    axes.set_ylim(bottom=low)
    return text.get_window_extent()


def draw_row(sheet, top, table, up, words, limits, own=None):
    """Two panels of one quantity: over iterations and over time."""
    least = LEAST_DISTANCE if own else LEAST_ERROR
    for i, (across, name) in enumerate((("iteration", "iterations"), ("seconds", "time"))):
        left = LEFT + i * (PANEL_WIDTH + ACROSS)
        axes = sheet.axes(left, top, PANEL_WIDTH, PANEL_HEIGHT)
        decades(axes, seconds if i else lambda v: f"{v:g}", power_of_ten, FONT_SIZE)
        lines = curves(table, across, up, least)
        draw_lines(axes, lines)
        axes.set_ylim(bottom=least)
        axes.set_xlim(*limits[i])
        ink = ink_within(axes)
        if own:
            said, place = OWN_ERROR[i]
            ink.add_box(draw_own_error(axes, own, said.format(length(own)), place), 3.0)
            axes.set_xlabel(f"{name} of one step", fontsize=10)
        if i:
            axes.tick_params(labelleft=False)
        else:
            axes.set_ylabel(words, fontsize=10)
        looks = ((*SOLVERS[name], points) for name, points in lines.items())
        named = [(said, look.color, look.text_color, points) for said, look, points in looks]
        label_lines(axes, named, lambda p: p[1:] or p, ink, size=FONT_SIZE, white=0.85)


def length(value):
    """A length with its unit."""
    units = (("m", 1.0), ("cm", 1e-2), ("mm", 1e-3))
    unit, scale = next((pair for pair in units if value >= pair[1]), ("µm", 1e-6))
    return f"{value / scale:.2g} {unit}"


def reach(table, across):
    """The range of a column, with some room."""
    values = [float(row[across]) for rows in table.values() for row in rows]
    return min(values) / 1.35, max(values) * 1.35


def draw(folder):
    """Draws the picture."""
    origin = read_facts(folder / "positions.json")
    scene = origin["scene"]
    setup = origin["setup"]["local_global"]
    once = setup["analysis_s"] + setup["factorization_s"]
    sheet = Sheet(WIDTH, HEIGHT)
    sheet.head(
        0.2,
        (0.3, 15, "What the iterations of one implicit step gain"),
        (
            0.6,
            10,
            f"cloth of {scene['nodes']} nodes and {scene['springs']} springs of "
            f"up to {origin['stiffness']:g} N/m, after {origin['swing']:g} s of swinging; one step of "
            f"h = {seconds(origin['step_size'])}, backward Euler, one core",
        ),
        (
            0.84,
            10,
            f"solid: one constant matrix, made once in {seconds(once)} (not in the times below); "
            "dashed: a new matrix at each iteration, in the times",
        ),
    )
    sheet.rule(1.02)
    energy = read(folder / "convergence.csv")
    limits = [reach(energy, across) for across in ("iteration", "seconds")]
    draw_row(sheet, TOP, energy, "relative_error", "energy above its minimum, relative", limits)
    below = TOP + PANEL_HEIGHT + DOWN
    positions = read(folder / "positions.csv")
    words = "farthest node from the converged step in m"
    draw_row(sheet, below, positions, "distance_to_converged", words, limits, origin["step_error"])
    sheet.save_as(folder, "local_global")


if __name__ == "__main__":
    main(draw)
