"""Draws the map of the fastest methods over stiffness ratio and accuracy.

Call: crossover.py DIR. Reads crossover.csv, kinds.csv and crossover.json in DIR and writes
crossover.png and crossover.svg there.

Each cell is one scene and one accuracy. Its hue is the kind of the fastest method; its depth and
the number in it say how many times slower the next method is. The line shows where the fastest
explicit and the fastest implicit method take the same time; log time is interpolated linearly in
log ratio.
"""

import math
from dataclasses import dataclass

from matplotlib import patheffects
from matplotlib.colors import to_hex, to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from measurements import parse, read_facts, read_rows
from sheet import Sheet, main
from style import INK, number, power_of_ten

KINDS = {"explicit": "#D55E00", "implicit": "#0072B2", "split": "#009E73", "rods": "#CC79A7"}
TITLES = {
    "explicit": "explicit",
    "implicit": "implicit",
    "split": "split: stiff springs apart",
    "rods": "rods in their place",
}
FAMILIES = {
    "frame": ("a soft cloth in a stiff frame", "frame / cloth"),
    "hem": ("a soft cloth with a stiff hem", "hem / cloth"),
    "whole": ("a cloth stiff against its weight", "k L / (m g)"),
    "chain": ("a chain with a stiff middle third", "stiff / soft springs"),
}
CELL_WIDTH, CELL_HEIGHT = 1.12, 0.8
LEFT, RIGHT, TOP, BOTTOM = 0.95, 0.2, 1.12, 0.72
NAME_SIZE, FACTOR_SIZE = 9.5, 8
# The depth of a cell's colour where the next method is as fast, and where it is so much slower.
FAINTEST, DEEPEST, DEEPEST_MARGIN = 0.22, 0.85, 10.0
EMPTY = "#F2F2F2"
BORDER = {"color": INK, "linewidth": 2.6, "marker": "o", "markersize": 6}


@dataclass(frozen=True)
class Cell:
    """The fastest method at one ratio and accuracy; an empty name where there is none."""

    method: str
    kind: str
    margin: float


def read_table(path, columns):
    """The rows of a table by ratio and accuracy, in the order of the file."""
    table = {}
    for line, row in read_rows(path, ("stiffness_ratio", "accuracy", *columns)):
        key = tuple(parse(path, line, row, name, True) for name in ("stiffness_ratio", "accuracy"))
        table.setdefault(key, []).append((line, row))
    if not table:
        raise BadInput(f"{path} has no rows.")
    return table


def read_kinds(path):
    """The fastest method of each kind by ratio and accuracy, as kind: (method, seconds)."""
    return {
        key: {
            row["kind"]: (row["method"], parse(path, line, row, "time_s", True))
            for line, row in rows
            if row["method"]
        }
        for key, rows in read_table(path, ("kind", "method", "time_s")).items()
    }


def read_cells(path, kinds):
    """The cells by ratio and accuracy."""
    cells = {}
    for key, [(line, row), *_] in read_table(path, ("method", "margin")).items():
        of_method = {method: kind for kind, (method, _) in kinds.get(key, {}).items()}
        if row["method"] and row["method"] not in of_method:
            raise BadInput(f"{path}, line {line}: {row['method']} is of no kind in kinds.csv.")
        margin = parse(path, line, row, "margin", False)
        cells[key] = Cell(row["method"], of_method.get(row["method"], ""), margin)
    return cells


def edges(values):
    """The borders of the cells around ascending positions: half way between neighbours."""
    middle = [(a + b) / 2 for a, b in zip(values, values[1:])]
    first = values[0] - (middle[0] - values[0] if middle else 0.5)
    last = values[-1] + (values[-1] - middle[-1] if middle else 0.5)
    return [first, *middle, last]


def border(kinds, ratios, accuracy):
    """The log of the least ratio above which the fastest implicit method stays faster than the
    fastest explicit one; None if it never does. Half way if one of them has no time."""
    leads = []
    for ratio in ratios:
        times = kinds.get((ratio, accuracy), {})
        explicit, implicit = times.get("explicit"), times.get("implicit")
        if explicit and implicit:
            leads.append((math.log10(ratio), math.log10(explicit[1] / implicit[1])))
        elif explicit or implicit:
            leads.append((math.log10(ratio), -math.inf if explicit else math.inf))
    if not leads or leads[-1][1] <= 0:
        return None
    behind = [i for i, (_, lead) in enumerate(leads) if lead <= 0]
    if not behind:
        return -math.inf
    (x, lead), (next_x, next_lead) = leads[behind[-1]], leads[behind[-1] + 1]
    if math.isinf(lead) or math.isinf(next_lead):
        return (x + next_x) / 2
    return x - lead * (next_x - x) / (next_lead - lead)


def depth(margin):
    """How deep a cell is coloured."""
    if math.isnan(margin):
        return DEEPEST
    share = min(math.log(max(margin, 1.0)) / math.log(DEEPEST_MARGIN), 1.0)
    return FAINTEST + (DEEPEST - FAINTEST) * share


def mixed(color, share):
    """The colour on white."""
    return to_hex([1 - share * (1 - part) for part in to_rgb(color)])


def regions(cells, ratios, accuracies):
    """Neighbouring cells of one method, as lists of (column, row)."""
    left = {
        (i, j): cell.method
        for i, ratio in enumerate(ratios)
        for j, accuracy in enumerate(accuracies)
        if (cell := cells.get((ratio, accuracy))) and cell.method
    }
    while left:
        region, front = [], [min(left)]
        method = left.pop(front[0])
        while front:
            i, j = front.pop()
            region.append((i, j))
            for near in ((i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
                if left.get(near) == method:
                    del left[near]
                    front.append(near)
        yield method, region


def widest_run(region):
    """The longest row of neighbouring cells of a region, the most central of these: (first column,
    last column, row)."""
    runs = []
    for row in {j for _, j in region}:
        columns = sorted(i for i, j in region if j == row)
        start = columns[0]
        for column, following in zip(columns, [*columns[1:], None]):
            if following != column + 1:
                runs.append((start, column, row))
                start = following
    longest = max(last - first for first, last, _ in runs)
    runs = [run for run in runs if run[1] - run[0] == longest]
    centre = sum(j for _, j in region) / len(region)
    return min(runs, key=lambda run: abs(run[2] - centre))


class Map:
    """The cells in their axes: log ratio to the right, finer accuracies upwards."""

    def __init__(self, sheet, cells, kinds):
        self.sheet = sheet
        self.cells = cells
        self.kinds = kinds
        self.ratios = sorted({ratio for ratio, _ in cells})
        self.accuracies = sorted({accuracy for _, accuracy in cells}, reverse=True)
        self.x = edges([math.log10(ratio) for ratio in self.ratios])
        self.y = edges([-math.log10(accuracy) for accuracy in self.accuracies])
        width, height = sheet.width - LEFT - RIGHT, sheet.height - TOP - BOTTOM
        self.axes = sheet.axes(LEFT, TOP, width, height)
        self.axes.set_xlim(self.x[0], self.x[-1])
        self.axes.set_ylim(self.y[0], self.y[-1])
        self.inches_per_x = width / (self.x[-1] - self.x[0])

    def draw(self, what):
        """Everything; `what`: the ratio in words."""
        for i, ratio in enumerate(self.ratios):
            for j, accuracy in enumerate(self.accuracies):
                self.draw_cell(i, j, self.cells.get((ratio, accuracy), Cell("", "", math.nan)))
        for method, region in regions(self.cells, self.ratios, self.accuracies):
            self.draw_outline(region)
            self.draw_name(method, region)
        self.draw_border()
        self.draw_axes(what)

    def middle(self, i, j):
        """The middle of a cell."""
        return (self.x[i] + self.x[i + 1]) / 2, (self.y[j] + self.y[j + 1]) / 2

    def draw_cell(self, i, j, cell):
        """One cell with its factor."""
        color = mixed(KINDS[cell.kind], depth(cell.margin)) if cell.method else EMPTY
        corner = (self.x[i], self.y[j])
        size = (self.x[i + 1] - self.x[i], self.y[j + 1] - self.y[j])
        hatch = {} if cell.method else {"hatch": "////", "edgecolor": "#D0D0D0"}
        self.axes.add_patch(Rectangle(corner, *size, facecolor=color, linewidth=0, **hatch))
        if not math.isnan(cell.margin):
            x, y = self.x[i] + 0.05 * size[0], self.y[j] + 0.07 * size[1]
            factor = f"{cell.margin:.1f}" if cell.margin < 9.95 else f"{cell.margin:.0f}"
            ink = "white" if depth(cell.margin) > 0.6 else INK
            self.axes.text(x, y, f"×{factor}", size=FACTOR_SIZE, color=ink, ha="left", va="bottom")

    def draw_outline(self, region):
        """White between one method and the next."""
        inside = set(region)
        for i, j in region:
            x, y = self.x[i : i + 2], self.y[j : j + 2]
            sides = {
                (i - 1, j): ((x[0], x[0]), y),
                (i + 1, j): ((x[1], x[1]), y),
                (i, j - 1): (x, (y[0], y[0])),
                (i, j + 1): (x, (y[1], y[1])),
            }
            for near, side in sides.items():
                if near not in inside:
                    self.axes.plot(*side, color="white", linewidth=2.2, solid_capstyle="butt")

    def draw_name(self, method, region):
        """The method's name in its region, in several lines where it is narrow."""
        first, last, row = widest_run(region)
        room = (self.x[last + 1] - self.x[first]) * self.inches_per_x - 0.1
        x = (self.x[first] + self.x[last + 1]) / 2
        y = self.y[row] + 0.77 * (self.y[row + 1] - self.y[row])
        deepest = min(
            depth(self.cells[self.ratios[i], self.accuracies[row]].margin)
            for i in range(first, last + 1)
        )
        text = self.axes.text(x, y, method, size=NAME_SIZE, ha="center", va="center", weight="bold")
        text.set_zorder(6)
        text.set_color("white" if deepest > 0.6 else INK)
        halo = "#00000000" if deepest > 0.6 else "#FFFFFFA0"
        text.set_path_effects([patheffects.withStroke(linewidth=2, foreground=halo)])
        if self.sheet.text_width(text) > room:
            text.set_y(self.y[row] + 0.65 * (self.y[row + 1] - self.y[row]))
            text.set_text(self.wrapped(text, method, room))
            text.set_linespacing(1.1)

    def wrapped(self, text, method, room):
        """The name broken after underscores, each line as long as there is room for."""
        lines = [""]
        for part in method.replace("_", "_ ").split():
            text.set_text(lines[-1] + part)
            if lines[-1] and self.sheet.text_width(text) > room:
                lines.append("")
            lines[-1] += part
        return "\n".join(lines)

    def draw_border(self):
        """Where explicit and implicit are equally fast."""
        points = []
        for j, accuracy in enumerate(self.accuracies):
            x = border(self.kinds, self.ratios, accuracy)
            if x is not None:
                points.append((min(max(x, self.x[0]), self.x[-1]), self.middle(0, j)[1]))
        if points:
            halo = [patheffects.withStroke(linewidth=5.5, foreground="white")]
            self.axes.plot(*zip(*points), zorder=5, clip_on=False, path_effects=halo, **BORDER)

    def draw_axes(self, what):
        """Ticks at the measured ratios and accuracies."""
        rows = range(len(self.accuracies))
        words = [
            power_of_ten(r) if abs(math.log10(r) % 1) < 1e-9 else number(r) for r in self.ratios
        ]
        self.axes.set_xticks([math.log10(r) for r in self.ratios], words)
        self.axes.set_yticks(
            [self.middle(0, j)[1] for j in rows], [power_of_ten(a) for a in self.accuracies]
        )
        self.axes.tick_params(length=0, labelsize=10, pad=5)
        for side in self.axes.spines.values():
            side.set_visible(False)
        self.axes.set_xlabel(f"stiffness ratio: {what}", fontsize=10.5, labelpad=7)
        self.axes.set_ylabel("relative position error at most", fontsize=10.5, labelpad=7)


def draw_header(sheet, family, until, kinds):
    """Title, subtitle and the key."""
    words = FAMILIES.get(family, (family, ""))[0]
    end = "" if until is None else f", to T = {number(until)} s"
    subtitle = "×: how many times slower the next method is, the deeper the colour the more"
    sheet.head(0.15, (0.25, 14, f"The fastest method: {words}{end}"), (0.54, 10, subtitle))
    there = [kind for kind in KINDS if any(kind in times for times in kinds.values())]
    keys = [Patch(facecolor=mixed(KINDS[kind], 0.7), label=TITLES[kind]) for kind in there]
    line = Line2D([], [], label="explicit and implicit equally fast", **BORDER)
    empty = Patch(facecolor=EMPTY, edgecolor="#D0D0D0", hatch="////", linewidth=0)
    empty.set_label("not reached or not certified")
    handles = [*keys, line, empty]
    sheet.figure.legend(
        handles=handles,
        loc="center left",
        bbox_to_anchor=(0.15 / sheet.width, 1 - 0.86 / sheet.height),
        ncol=5 if len(handles) <= 5 else 3,
        frameon=False,
        fontsize=9.5,
        handlelength=1.6,
        columnspacing=1.4,
        borderaxespad=0,
        borderpad=0,
    )


def draw(folder):
    """Draws the map."""
    kinds = read_kinds(folder / "kinds.csv")
    cells = read_cells(folder / "crossover.csv", kinds)
    origin = read_facts(folder / "crossover.json")
    columns = len({ratio for ratio, _ in cells})
    rows = len({accuracy for _, accuracy in cells})
    width = max(9.0, LEFT + columns * CELL_WIDTH + RIGHT)
    sheet = Sheet(width, TOP + rows * CELL_HEIGHT + BOTTOM)
    family = origin.get("family", folder.name)
    Map(sheet, cells, kinds).draw(FAMILIES.get(family, ("", family))[1])
    draw_header(sheet, family, origin.get("until"), kinds)
    sheet.save_as(folder, "crossover")


if __name__ == "__main__":
    main(draw)
