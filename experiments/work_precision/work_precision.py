"""Draws the work-precision chart of one experiment: time of a run against error reached.

Call: work_precision.py DIR [--all]. Reads points.csv and chart.json in DIR. Writes chart and
chart_energy there, as .png and .svg. chart is over the position error. If the end is beyond the
horizon of a chaotic motion, it is over the kind of error that still means something. chart_energy
is over the energy error. Up to a dozen methods stand out; others are pale and failures are counted.
--all names every method and shows its failed runs.
"""

import sys

from matplotlib.lines import Line2D

import causes
import failures
from band import draw_band
from chart import Chart
from emphasis import Everything, Prominent
from measurements import status_of
from names import shown
from record import read_record, sweeps
from sheet import Sheet
from style import STOCK, number, use_style

WIDTH = 10.0
MARGIN = 0.15
LEFT, RIGHT = 0.95, 0.2
HEADER = 1.07
KEY = 0.24
HORIZON = 0.42
HEADING = 0.42
WARNING = "#A33B00"
BAND = 0.25
BAND_GAP = 0.06
AXIS_TEXT = 0.68
ROOMY_METHODS = 16


def axes_height(runs, emphasis):
    """The height of the main axes in inches: many labels need room."""
    if all(run.failure for run in runs):
        return 3.4
    labelled = len({run.method for run in runs}.intersection(emphasis.shown))
    return 4.35 + 0.08 * max(0, labelled - ROOMY_METHODS)


def draw_header(sheet, study, view):
    """Title and subtitle; and what a reader must know before the errors."""
    end = "T" if study.until is None else f"T = {number(study.until)} s"
    title = f"{shown(study.scene)}: time of a run against {view.quantity.title} {end}"
    sheet.head(MARGIN, (0.25, 14, title), (0.54, 10, view.subtitle))
    for line, words in enumerate(study.caveats):
        top = 0.83 + HORIZON * line
        sheet.text(MARGIN, top, words, size=10, color=WARNING, va="center")


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


def draw_key(sheet, top, emphasis):
    """The key of the lines of each family, and of pale ones."""
    families = dict.fromkeys(emphasis.looks[method].family for method in emphasis.shown)
    lines = [key_line(family) for family in sorted(families, key=lambda family: family is STOCK)]
    rest = emphasis.rest()
    if rest:
        words, style = rest
        lines.append(Line2D([], [], label=words, **style))
    sheet.figure.legend(
        handles=lines,
        loc="center left",
        bbox_to_anchor=(MARGIN / sheet.width, 1 - top / sheet.height),
        ncol=max(1, len(lines)),
        frameon=False,
        fontsize=10,
        handlelength=3.2,
        columnspacing=1.5,
        borderaxespad=0,
        borderpad=0,
    )


def draw_panel(sheet, top, view, emphasis):
    """The axes of one view and, where it has a front, the band above."""
    width = WIDTH - LEFT - RIGHT
    height = axes_height(view.runs, emphasis)
    axes = sheet.axes(LEFT, top + band_height(view), width, height)
    Chart(axes, view, emphasis).draw()
    if view.front:
        band = (LEFT, top, width, BAND)
        draw_band(sheet, band, view.front, axes.get_xlim(), view.floor, emphasis.looks)


def band_height(view):
    """The height in inches of the band over a view's axes with its gap."""
    return BAND + BAND_GAP if view.front else 0.0


def panel_height(view, emphasis):
    """The height in inches of a view's axes with their band and numbers."""
    return band_height(view) + axes_height(view.runs, emphasis) + AXIS_TEXT


def draw(study, views, everything):
    """The whole picture of one view of a study and more below it as a sheet; of every method, or
    with those that stand out."""
    main, *more = views
    emphasis = Everything(views) if everything else Prominent(views)
    strip = failures if everything else causes
    failed = failures.failing(sweeps(main.runs))
    header = HEADER + HORIZON * len(study.caveats)
    panels = sum(panel_height(view, emphasis) for view in views)
    strip_top = header + panels + HEADING * len(more)
    sheet = Sheet(WIDTH, strip_top + strip.strip_height(failed))
    draw_header(sheet, study, main)
    draw_panel(sheet, header, main, emphasis)
    draw_key(sheet, header - KEY, emphasis)
    top = header + panel_height(main, emphasis)
    for view in more:
        sheet.rule(top)
        sheet.text(MARGIN, top + HEADING / 2, view.subtitle, size=10, va="center")
        draw_panel(sheet, top + HEADING, view, emphasis)
        top += HEADING + panel_height(view, emphasis)
    if failed:
        strip.draw_strip(sheet, strip_top, failed, emphasis.looks)
    return sheet


def pictures(study):
    """The views of each picture by its name: beyond the horizon, others stand in the place of the
    positions."""
    others = ("momentum", "modes") if study.is_beyond_horizon else ()
    yield "chart", [study.judged, *(study.views[name] for name in others if name in study.views)]
    if "energy" in study.views:
        yield "chart_energy", [study.views["energy"]]


def draw_all(directory, everything):
    """Draws the charts of the directory."""
    study = read_record(directory)
    for name, views in pictures(study):
        draw(study, views, everything).save_as(directory, name)


def main(arguments):
    """Draws the charts of the directory named on the command line; returns the exit status."""
    everything = "--all" in arguments
    directories = [word for word in arguments if word != "--all"]
    if len(directories) != 1 or directories[0].startswith("-"):
        print("Usage: work_precision.py DIR [--all]", file=sys.stderr)
        return 2
    use_style()
    return status_of(draw_all, directories[0], everything)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
