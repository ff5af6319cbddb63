"""Draws the work-precision chart of one experiment: time of a run against error reached.

Call: work_precision.py DIR. Reads points.csv, front.csv and, if there, reference.json in DIR and
writes chart.png and chart.svg there.
"""

import os
import sys

from matplotlib.lines import Line2D

import failures
import measurements
from band import draw_band
from chart import BACKGROUND, MATTERS, NEAR, Chart
from sheet import Sheet
from style import FAINT, assign_looks, number, use_style

WIDTH = 10.0
MARGIN = 0.15
LEFT, RIGHT = 0.95, 0.2
HEADER = 1.07
BAND = 0.25
BAND_GAP = 0.06
AXIS_TEXT = 0.68
ROOMY_METHODS = 16


def axes_height(runs):
    """The height of the main axes in inches: crowded charts need room for their labels."""
    if all(run.failure for run in runs):
        return 3.4
    methods = len({run.method for run in runs})
    return 4.35 + 0.08 * max(0, methods - ROOMY_METHODS)


def draw_header(sheet, scene, until):
    """Title and subtitle."""
    end = "" if until is None else f" at T = {number(until)} s"
    title = f"{scene}: time of a run against its error{end}"
    subtitle = "position error at t = T: max over nodes, divided by the largest displacement"
    sheet.text(MARGIN, 0.25, title, size=14, weight="bold", va="center")
    sheet.text(MARGIN, 0.54, subtitle, size=10, color=FAINT, va="center")


def key_line(family):
    """A sample of the lines of a family."""
    color = family.colors[0]
    return Line2D(
        [],
        [],
        color=color,
        linestyle=family.line,
        linewidth=family.width,
        marker="o",
        markerfacecolor=color if family.filled else "white",
        markeredgewidth=1.2,
        label=family.title,
    )


def draw_key(sheet, looks, crowded):
    """How the lines of each family look, and those in the background."""
    lines = [key_line(family) for family in dict.fromkeys(look.family for look in looks.values())]
    if crowded:
        words = f"faint: never within {NEAR:g} × the fastest at errors below {MATTERS:g}"
        faint = {"color": FAINT, "alpha": BACKGROUND, "linewidth": 1.2, "marker": "o"}
        lines.append(Line2D([], [], label=words, **faint))
    sheet.figure.legend(
        handles=lines,
        loc="center left",
        bbox_to_anchor=(MARGIN / sheet.width, 1 - 0.83 / sheet.height),
        ncol=max(1, len(lines)),
        frameon=False,
        fontsize=10,
        handlelength=3.2,
        columnspacing=1.5,
        borderaxespad=0,
        borderpad=0,
    )


def draw(runs, front, reference, fallback_scene):
    """The whole picture as a sheet."""
    looks = assign_looks({run.method: run.family for run in runs})
    failed = failures.failing(measurements.sweeps(runs))
    axes_top = HEADER + BAND + BAND_GAP
    strip_top = axes_top + axes_height(runs) + AXIS_TEXT
    sheet = Sheet(WIDTH, strip_top + failures.strip_height(failed))
    scene = reference.scene or (runs[0].scene if runs else "") or fallback_scene
    draw_header(sheet, scene, reference.until)
    axes = sheet.axes(LEFT, axes_top, WIDTH - LEFT - RIGHT, axes_height(runs))
    chart = Chart(axes, runs, reference, looks)
    chart.draw()
    draw_key(sheet, looks, chart.crowded)
    rectangle = (LEFT, HEADER, WIDTH - LEFT - RIGHT, BAND)
    if front:
        draw_band(sheet, rectangle, front, axes.get_xlim(), reference.certified, looks)
    if failed:
        failures.draw_strip(sheet, strip_top, failed, looks)
    return sheet


def main(arguments):
    """Draws the chart of the directory named on the command line; returns the exit status."""
    if len(arguments) != 1:
        print("Usage: work_precision.py DIR", file=sys.stderr)
        return 2
    directory = arguments[0]
    try:
        runs = measurements.read_runs(os.path.join(directory, "points.csv"))
        front = measurements.read_front(os.path.join(directory, "front.csv"), runs)
        reference = measurements.read_reference(os.path.join(directory, "reference.json"))
    except measurements.BadInput as error:
        print(error, file=sys.stderr)
        return 2
    use_style()
    sheet = draw(runs, front, reference, os.path.basename(os.path.abspath(directory)))
    for name in ("chart.png", "chart.svg"):
        sheet.save(os.path.join(directory, name))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
