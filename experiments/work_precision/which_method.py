"""Draws which method is the fastest on each of several scenes, at each accuracy.

Call: which_method.py PICTURE.png DIR... Reads what work_precision wrote into each folder: points.csv,
its sidecar points.json and chart.json. A row is a scene, from soft to stiff: the more steps Verlet must
take, the lower.
"""

import os
import sys

import scene_row
from fastest_table import Cells, draw_cells, draw_heads, draw_key, sundials_in_words
from measurements import status_of
from names import shown
from record import read_record
from sheet import Sheet
from style import COOL, FAINT, use_style

WIDTH, MARGIN = 10.0, 0.15
ROW, GAP = 0.66, 0.06
CELLS = Cells(scene_row.DECADES, 1.93, 0.76, ROW, name_depth=0.24, time_depth=ROW - 0.12)
TOP, FOOT = 1.66, 0.62
FACT_SIZE = 8.5
TITLES = {
    "pendulum": "elastic pendulum",
    "cloth": "hanging cloth",
    "lattice": "cantilever block",
    "fpu": "Fermi-Pasta-Ulam",
    "framed_cloth": "cloth, stiff frame",
    "stiff_frame": "cloth, stiffer frame",
}


def read(directory):
    """The row of the scene whose results are in a folder; raises BadInput where these are not of
    work_precision."""
    record = read_record(directory)
    name, facts = scene_row.read_sidecar(os.path.join(directory, "points.json"))
    methods = scene_row.of_record(record, scene_row.by_accuracy(record.judged.front))
    return scene_row.Row(TITLES.get(name, shown(name)), **facts, **methods)


def draw_scene(sheet, top, row):
    """What is said of a scene, to the left of its cells."""
    sheet.text(MARGIN, top + 0.13, row.title, size=10.5, weight="bold", va="center")
    for line, words in enumerate((row.size, row.duration)):
        height = top + 0.34 + 0.18 * line
        sheet.text(MARGIN, height, words, size=FACT_SIZE, color=FAINT, va="center")


def draw_sundials(sheet, top, row):
    """How many times as long the best of SUNDIALS takes, to the right of the cells."""
    ratio, lines = sundials_in_words(row)
    if not ratio:
        sheet.text(CELLS.right, top + ROW / 2, "none", size=10.5, color=FAINT, va="center")
        return
    style = {"size": 13, "weight": "bold", "color": COOL[0], "va": "center"}
    sheet.text(CELLS.right, top + 0.15, ratio, **style)
    for line, words in enumerate(lines):
        height = top + 0.37 + 0.17 * line
        sheet.text(CELLS.right, height, words, size=FACT_SIZE, color=FAINT, va="center")


def draw_header(sheet, rows):
    """Title, key and the heads of the columns."""
    sheet.text(MARGIN, 0.27, "Which method, when?", size=16, weight="bold", va="center")
    most = max(row.methods for row in rows)
    words = (
        f"the fastest of {most} methods on each scene, at each accuracy, and the time of its run"
    )
    sheet.text(MARGIN, 0.6, words, size=10.5, color=FAINT, va="center")
    draw_key(sheet, MARGIN, 0.96, WIDTH, set().union(*(row.front_kinds for row in rows)))
    style = {"size": 10, "weight": "bold", "va": "center"}
    sheet.text(MARGIN, TOP - 0.16, "soft to stiff ▼", **style)
    draw_heads(sheet, TOP, CELLS, "position error")


def draw_foot(sheet, top, rows):
    """What a reader must know of the numbers."""
    processors = ", ".join(dict.fromkeys(row.processor for row in rows))
    lines = (
        f"Times of whole runs on one core of {processors}. Errors at the end T, over the largest"
        " displacement. Steps: the fewest that Verlet can take, T ω/2 at the largest ω.",
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
        draw_cells(sheet, top, row, CELLS)
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
    return status_of(lambda: draw([read(directory) for directory in directories]).save(picture))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
