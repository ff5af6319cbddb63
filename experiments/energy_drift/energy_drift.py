"""Draws where each method's energy goes over a long run of one scene.

Call: energy_drift.py DIR, the folder with drift.csv, summary.csv and tolerance.csv of the program
energy_drift; writes DIR/energy_drift.png and DIR/energy_drift.svg. The upper panel shows the size of
the energy error over time for some methods of each verdict. The one below shows that of the adaptive
methods over their tolerance. A table has the verdict on every method. Each verdict has one colour in
all three.
"""

import sys

import numpy as np
from matplotlib.lines import Line2D

from drift_table import FATES, draw_table, label, table_height
from labels import Ink, label_lines
from measurements import grouped, optional, read_facts, read_table
from names import shown
from sheet import Sheet, main
from style import FAINT, GRID, log_ticks, number

WIDTH = 8.95
LEFT, PANEL_WIDTH, LABELS = 0.75, 6.35, 1.6
TOP, PANEL_HEIGHT, DOWN, TOLERANCE_HEIGHT, FOOT = 1.35, 4.3, 0.95, 2.35, 0.65
SMALL = 9
LABEL_STEP = 0.16
MOST_LINES, MOST_TOLERANCE_LABELS = 11, 14
# Below this an error is not told from none.
LEAST = 1e-17
LARGEST = 1e3
BINS_A_DECADE = 10

# The methods whose errors are drawn over time first, where they were run.
TELLING = (
    "verlet",
    "rk4",
    "implicit_euler",
    "explicit_euler",
    "symplectic_euler",
    "kahan_li8",
    "implicit_midpoint",
    "discrete_gradient",
    "generalized_alpha",
    "blanes_moan4",
    "cvode_adams",
    "semi_implicit_euler",
    "exact",
)


def key(row):
    """What tells runs apart."""
    return row["method"], float(row["value"])


def one_a_method(summary):
    """A row a method: of adaptive ones, that of the middle one of the tolerances."""
    runs = grouped(summary, lambda row: row["method"]).values()
    return [sorted(rows, key=lambda row: -float(row["value"]))[len(rows) // 2] for rows in runs]


def envelope(times, errors):
    """The largest errors in intervals of time that are equally long on a logarithmic axis."""
    good = (times > 0) & np.isfinite(errors) & (errors < LARGEST)
    times, errors = times[good], np.maximum(errors[good], LEAST)
    if times.size == 0:
        return times, errors
    places = np.floor(BINS_A_DECADE * np.log10(times)).astype(int)
    kept = [np.flatnonzero(places == place) for place in np.unique(places)]
    return (
        np.array([times[own].mean() for own in kept]),
        np.array([errors[own].max() for own in kept]),
    )


def spread(wanted, step, low, high):
    """Places at least `step` from each other, near those wanted; both in one order."""
    order = np.argsort(wanted)
    places = np.array(wanted, dtype=float)[order]
    for _ in range(200):
        for i in range(1, len(places)):
            overlap = step - (places[i] - places[i - 1])
            if overlap > 0:
                places[i - 1] -= overlap / 2
                places[i] += overlap / 2
        places = np.clip(places, low, high)
    # The limits may have pushed labels together.
    for i in range(1, len(places)):
        places[i] = max(places[i], places[i - 1] + step)
    result = np.empty_like(places)
    result[order] = places
    return result


def label_ends(sheet, axes, box, ends):
    """Writes names to the right of a panel, each beside the end of its line or led to it.

    box: left, top, width and height of the panel in inches; ends: name, colour, x, y of each.
    """
    left, top, width, height = box
    if not ends:
        return
    to_pixels = axes.transData.transform
    dpi = sheet.figure.dpi
    points = [to_pixels((x, y)) / dpi for _, _, x, y in ends]
    wanted = [sheet.height - point[1] for point in points]
    places = spread(wanted, LABEL_STEP, top, top + height)
    for (name, color, _, _), point, at, place in zip(ends, points, wanted, places):
        start = left + width + 0.16
        xs = np.array([point[0] + 0.03, left + width + 0.04, start - 0.03]) / sheet.width
        ys = 1 - np.array([at, at, place]) / sheet.height
        line = Line2D(xs, ys, color=color, linewidth=0.6, alpha=0.6)
        sheet.figure.add_artist(line)
        sheet.text(start, place, name, size=SMALL, color=color, va="center")


def label_paths(sheet, axes, lines, others):
    """Writes the names of lines near their ends, in the panel or to the right of it.

    lines: name, colour, x and y of each; others: texts to be left readable.
    """
    box = axes.get_window_extent()
    bounds = (box.x0, box.y0, box.x1 + LABELS * sheet.figure.dpi, box.y1)
    ink = Ink(bounds)
    for text in others:
        extent = text.get_window_extent()
        for height in np.linspace(extent.y0, extent.y1, 5):
            ink.add_line((extent.x0, height), (extent.x1, height), 20.0)
    named = [(name, color, color, list(zip(xs, ys))) for name, color, xs, ys in lines]
    label_lines(axes, named, lambda pixels: pixels[-3:], ink, size=SMALL, white=0.85)


def telling(rows):
    """The runs that are drawn over time: the telling methods first, then others of rare fates."""
    chosen = [row for name in TELLING for row in rows if row["method"] == name]
    for row in rows:
        if all(row["fate"] != other["fate"] for other in chosen):
            chosen.insert(0, row)
    others = [row for row in rows if row not in chosen]
    return (chosen + others)[:MOST_LINES]


def draw_guides(axes, low, high, bottom):
    """Lines of slope 1/2 and 1 from the lower left; returns their names as they are drawn."""
    names = []
    for power, words in ((0.5, "√t"), (1.0, "t")):
        start = 3 * bottom
        times = np.array([low, high])
        axes.plot(times, start * (times / low) ** power, color=GRID, linewidth=2.2, zorder=0)
        end = (high, start * (high / low) ** power)
        style = {"textcoords": "offset points", "color": FAINT, "ha": "right", "zorder": 5}
        style["bbox"] = {"facecolor": "white", "alpha": 0.85, "edgecolor": "none", "pad": 0.4}
        names.append(axes.annotate(words, end, (-4, 2), **style))
    return names


def panel(sheet, box, title, across):
    """The axes of a panel, both logarithmic, with its words."""
    left, top, _, _ = box
    sheet.text(left - 0.5, top - 0.17, title, weight="bold", size=10)
    axes = sheet.axes(*box)
    axes.set(xscale="log", yscale="log")
    axes.grid(True)
    log_ticks(axes.xaxis)
    log_ticks(axes.yaxis)
    axes.set_xlabel(across, labelpad=2)
    return axes


def draw_paths(sheet, rows, drift):
    """The errors over time."""
    box = (LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT)
    axes = panel(sheet, box, "Size of the energy error over time", "t in s")
    lines = []
    for row in telling(rows):
        path = drift.get(key(row))
        if path is None:
            continue
        times, errors = envelope(path[:, 0], np.abs(path[:, 1]))
        if times.size:
            lines.append((row, times, errors))
    if not lines:
        sys.exit("energy_drift.py: no run came far enough to be drawn")
    low = min(times[0] for _, times, _ in lines)
    high = max(times[-1] for _, times, _ in lines)
    least = min(errors.min() for _, _, errors in lines)
    axes.set_xlim(low, high)
    axes.set_ylim(max(least / 3, LEAST), 3 * LARGEST)
    guides = draw_guides(axes, low, high, max(least / 3, LEAST))
    named = []
    for row, times, errors in lines:
        color = FATES[row["fate"]][2]
        axes.plot(times, errors, color=color, linewidth=1.5)
        if times[-1] < 0.8 * high:
            axes.plot(times[-1:], errors[-1:], "o", color=color, markersize=3.5)
        named.append((label(row), color, times, errors))
    label_paths(sheet, axes, named, guides)


def draw_tolerances(sheet, top, summary):
    """The errors at the end over the tolerance."""
    adaptive = [row for row in summary if row["knob"] == "rtol"]
    runs = grouped(adaptive, lambda row: row["method"])
    runs = {name: rows for name, rows in runs.items() if len(rows) > 1}
    if not runs:
        return
    title = "Energy error of adaptive methods at their end, over rtol"
    box = (LEFT, top, PANEL_WIDTH, TOLERANCE_HEIGHT)
    axes = panel(sheet, box, title, "rtol (finer to the right)")
    ends = []
    for name, rows in runs.items():
        rows.sort(key=lambda row: -float(row["value"]))
        values = np.array([float(row["value"]) for row in rows])
        errors = np.array([abs(optional(row["energy_error_end"])) for row in rows])
        errors = np.clip(errors, LEAST, LARGEST)
        color = FATES[rows[len(rows) // 2]["fate"]][2]
        axes.plot(values, errors, color=color, linewidth=1.1, alpha=0.85)
        for row, value, error in zip(rows, values, errors):
            axes.plot([value], [error], "o", color=FATES[row["fate"]][2], markersize=3.8)
        ends.append((name, color, values[-1], errors[-1]))
    axes.invert_xaxis()
    ends.sort(key=lambda end: -end[3])
    if len(ends) > MOST_TOLERANCE_LABELS:  # the ends of the list and some between
        places = np.linspace(0, len(ends) - 1, MOST_TOLERANCE_LABELS).round().astype(int)
        ends = [ends[place] for place in sorted(set(places))]
    label_ends(sheet, axes, box, ends)


def draw(folder):
    """Draws the picture."""
    origin = read_facts(folder / "summary.json")
    summary = read_table(folder / "summary.csv")
    drift = {}
    for row in read_table(folder / "drift.csv"):
        point = (float(row["t"]), optional(row["relative_error"]))
        drift.setdefault(key(row), []).append(point)
    drift = {run: np.array(path) for run, path in drift.items()}
    rows = one_a_method(summary)
    has_tolerances = any(row["knob"] == "rtol" for row in summary)
    panels = TOP + PANEL_HEIGHT + (DOWN + TOLERANCE_HEIGHT if has_tolerances else 0) + FOOT
    sheet = Sheet(WIDTH, panels + table_height(rows) + 0.1)
    until, h = origin["until"], origin["step_size"]
    title = f"{shown(origin['scene']['name'])}: where the energy goes"
    run = f"{number(until / h)} steps of h = {number(h)} s, to t = {number(until)} s"
    scale = f"{number(origin['energy_scale'])} J"
    errors = f"errors E(t) − E(0) as parts of the largest kinetic energy, {scale}"
    sheet.head(0.15, (0.25, 14, title), (0.52, 10, run), (0.72, 10, errors))
    sheet.rule(0.9)
    draw_paths(sheet, rows, drift)
    if has_tolerances:
        draw_tolerances(sheet, TOP + PANEL_HEIGHT + DOWN, summary)
    draw_table(sheet, panels, rows, until)
    sheet.save_as(folder, "energy_drift")


if __name__ == "__main__":
    main(draw)
