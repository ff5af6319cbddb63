"""Draws which method is the fastest on each of several scenes, at each accuracy.

Call: which_method.py PICTURE.png DIR... Reads what work_precision wrote into each folder: points.csv,
front.csv and the sidecar points.json. A row is a scene, from soft to stiff: the more steps Verlet must
take, the lower.
"""

import statistics
import sys

from matplotlib.patches import Rectangle

import scene_row
from measurements import BadInput
from sheet import Sheet
from style import COOL, FAINT, INK, STOCK, WARM, Look, power_of_ten, seconds, use_style

EXPONENTS = range(1, 10)
WIDTH, MARGIN = 10.0, 0.15
LEFT, COLUMN, ROW, GAP = 1.93, 0.76, 0.66, 0.06
RIGHT = LEFT + COLUMN * len(EXPONENTS) + 0.14
TOP, FOOT = 1.66, 0.62
TINT = 0.26
NAME_SIZES, TIME_SIZE, FACT_SIZE = (10.5, 10, 9.5, 9, 8.5, 8, 7.5), 8.5, 8.5

# Warm kinds take forces alone; cool ones treat stiff springs apart or solve linear systems.
COLORS = {
    "Euler and Verlet": WARM[2],
    "symmetric multistep": WARM[3],
    "other explicit": WARM[0],
    "multirate": COOL[1],
    "implicit": COOL[0],
    "SUNDIALS": FAINT,
}


def broken(name):
    """A name in two lines of as equal lengths as its underscores allow."""
    words = name.split("_")
    ways = [("_".join(words[:i]) + "_", "_".join(words[i:])) for i in range(1, len(words))]
    return "\n".join(min(ways, key=lambda way: max(map(len, way)))) if ways else name


def draw_name(sheet, middle, top, room, method, color):
    """The name of a method, centred in a cell: in one line or two, as large as the room lets it be."""
    style = {"color": color, "ha": "center", "va": "center", "linespacing": 1.05}
    text = sheet.text(middle, top + 0.24, method, **style)
    for size in NAME_SIZES:
        for words in (method, broken(method)):
            text.set_text(words)
            text.set_size(size)
            if sheet.text_width(text) < room - 0.05:
                return


def draw_cells(sheet, top, row):
    """The cells of a scene: the fastest method, its time below each accuracy."""
    axes = sheet.axes(LEFT, top, COLUMN * len(EXPONENTS), ROW)
    axes.set_xlim(0, len(EXPONENTS))
    axes.set_ylim(0, 1)
    axes.set_axis_off()
    for method, first, last in row.stretches:
        look = Look(COLORS[row.kinds[method]], "o", STOCK)
        box = {"facecolor": look.color, "alpha": TINT, "edgecolor": "none"}
        axes.add_patch(Rectangle((first - 1, 0), last - first + 1, 1, **box))
        for edge in (first - 1, last):
            axes.axvline(edge, color="white", linewidth=3)
        room = COLUMN * (last - first + 1)
        middle = LEFT + COLUMN * (first - 1) + room / 2
        draw_name(sheet, middle, top, room, method, look.text_color)
    for exponent in EXPONENTS:
        point = row.front.get(exponent)
        words = seconds(float(f"{point.time:.2g}")) if point else "–"
        height = top + (ROW - 0.12 if point else ROW / 2)
        style = {
            "size": TIME_SIZE,
            "color": INK if point else FAINT,
            "ha": "center",
            "va": "center",
        }
        sheet.text(LEFT + COLUMN * (exponent - 0.5), height, words, **style)


def draw_scene(sheet, top, row):
    """What is said of a scene, to the left of its cells."""
    sheet.text(MARGIN, top + 0.13, row.title, size=10.5, weight="bold", va="center")
    for line, words in enumerate((row.size, row.duration)):
        height = top + 0.34 + 0.18 * line
        sheet.text(MARGIN, height, words, size=FACT_SIZE, color=FAINT, va="center")


def draw_sundials(sheet, top, row):
    """How many times as long the best of SUNDIALS takes, to the right of the cells."""
    ratios = row.ratios.values()
    if not ratios:
        sheet.text(RIGHT, top + ROW / 2, "none", size=10.5, color=FAINT, va="center")
        return
    middle, low, high = map(rounded, (statistics.median(ratios), min(ratios), max(ratios)))
    style = {"size": 13, "weight": "bold", "color": COOL[0], "va": "center"}
    sheet.text(RIGHT, top + 0.15, f"{middle} ×", **style)
    lines = [f"{low} to {high}"] if low != high else []
    if len(row.ratios) < len(row.front):
        lines.append(f"none below {power_of_ten(10.0 ** -max(row.ratios))}")
    for line, words in enumerate(lines):
        height = top + 0.37 + 0.17 * line
        sheet.text(RIGHT, height, words, size=FACT_SIZE, color=FAINT, va="center")


def rounded(ratio):
    """A ratio in two digits."""
    return f"{ratio:.1f}" if ratio < 9.95 else f"{float(f'{ratio:.2g}'):.0f}"


def draw_key(sheet, top, kinds):
    """The colours of the kinds, side by side."""
    left = MARGIN
    for kind in filter(kinds.__contains__, COLORS):
        box = {"facecolor": COLORS[kind], "alpha": TINT + 0.15, "edgecolor": "none", "pad": 4}
        sheet.text(left + 0.05, top, "     ", size=9, va="center", bbox=box)
        text = sheet.text(left + 0.36, top, kind, size=10, va="center")
        left += 0.36 + sheet.text_width(text) + 0.3


def draw_header(sheet, rows):
    """Title, key and the heads of the columns."""
    sheet.text(MARGIN, 0.27, "Which method, when?", size=16, weight="bold", va="center")
    most = max(row.methods for row in rows)
    words = (
        f"the fastest of {most} methods on each scene, at each accuracy, and the time of its run"
    )
    sheet.text(MARGIN, 0.6, words, size=10.5, color=FAINT, va="center")
    draw_key(sheet, 0.96, {row.kinds[point.method] for row in rows for point in row.front.values()})
    head, upper, lower = {"size": 10, "va": "center"}, TOP - 0.39, TOP - 0.16
    sheet.text(MARGIN, lower, "soft to stiff ▼", weight="bold", **head)
    middle = LEFT + COLUMN * len(EXPONENTS) / 2
    sheet.text(middle, upper, "position error at most", ha="center", color=FAINT, **head)
    for exponent in EXPONENTS:
        place = LEFT + COLUMN * (exponent - 0.5)
        sheet.text(place, lower, power_of_ten(10.0**-exponent), ha="center", **head)
    for height, words in ((upper, "SUNDIALS’"), (lower, "best takes")):
        sheet.text(RIGHT, height, words, color=FAINT, **head)


def draw_foot(sheet, top, rows):
    """What a reader must know of the numbers."""
    processors = ", ".join(dict.fromkeys(row.processor for row in rows))
    lines = (
        f"Times of whole runs on one core of {processors}. Errors at the end T, over the largest"
        " displacement. Steps: the fewest of Verlet, T ω/2 at the largest ω.",
        "SUNDIALS’ best: how many times as long as the fastest, median over the accuracies, least to"
        " most. –: no run reached it in the time it had.",
    )
    for line, words in enumerate(lines):
        style = {"size": FACT_SIZE, "color": FAINT, "va": "center"}
        sheet.text(MARGIN, top + 0.2 + 0.19 * line, words, **style)


def draw(rows):
    """The whole picture as a sheet."""
    rows = sorted(rows, key=lambda row: row.steps or 0.0)
    height = TOP + len(rows) * (ROW + GAP) + FOOT
    sheet = Sheet(WIDTH, height)
    draw_header(sheet, rows)
    for index, row in enumerate(rows):
        top = TOP + index * (ROW + GAP)
        draw_scene(sheet, top, row)
        draw_cells(sheet, top, row)
        draw_sundials(sheet, top, row)
    draw_foot(sheet, height - FOOT, rows)
    return sheet


def main(arguments):
    """Draws the picture named first from the folders named after it; returns the exit status."""
    if len(arguments) < 2:
        print("Usage: which_method.py PICTURE.png DIR...", file=sys.stderr)
        return 2
    picture, *directories = arguments
    use_style()
    try:
        draw([scene_row.read(directory) for directory in directories]).save(picture)
    except BadInput as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
