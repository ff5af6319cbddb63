"""A table of the fastest methods: a row a scene, a column an accuracy."""

import math
import statistics
from dataclasses import dataclass

from matplotlib.patches import Rectangle

from method_kinds import COLORS
from style import FAINT, INK, STOCK, Look, number, power_of_ten, seconds

TINT = 0.26
NAME_SIZES, TIME_SIZE, MARGIN_SIZE = (10.5, 10, 9.5, 9, 8.5, 8, 7.5), 8.5, 7
KEY_LINE = 0.3


@dataclass(frozen=True)
class Cells:
    """The accuracies of a table, and its measures in inches: left end and width of the first
    column, height of a row, depths of names and times in it, size of a name in two lines."""

    accuracies: tuple
    left: float
    column: float
    row: float
    name_depth: float
    time_depth: float
    two_lines_size: float = NAME_SIZES[0]

    @property
    def width(self):
        """The width of all columns together."""
        return self.column * len(self.accuracies)

    @property
    def right(self):
        """Where what is right of the cells begins."""
        return self.left + self.width + 0.14

    def middle(self, place):
        """The middle of a column."""
        return self.left + self.column * (place + 0.5)


def accuracy_in_words(accuracy):
    """An accuracy as the head of its column: 1e-3, 3e-4."""
    words = power_of_ten(accuracy)
    return words if math.isclose(float(words), accuracy, rel_tol=1e-3) else number(accuracy)


def times_as_long(ratio):
    """A ratio of times in two digits."""
    return f"{ratio:.1f}" if ratio < 9.95 else f"{float(f'{ratio:.2g}'):.0f}"


def broken(name):
    """A name in two lines of as equal lengths as its underscores allow."""
    words = name.split("_")
    ways = [("_".join(words[:i]) + "_", "_".join(words[i:])) for i in range(1, len(words))]
    return "\n".join(min(ways, key=lambda way: max(map(len, way)))) if ways else name


def draw_name(sheet, middle, height, room, method, color, two_lines_size):
    """The name of a method, centred in a cell: in one line or, up to a size, in two; as large as
    the room lets it be."""
    style = {"color": color, "ha": "center", "va": "center", "linespacing": 1.05}
    text = sheet.text(middle, height, method, **style)
    for size in NAME_SIZES:
        for words in (method, broken(method))[: 2 if size <= two_lines_size else 1]:
            text.set_text(words)
            text.set_size(size)
            if sheet.text_width(text) < room - 0.05:
                return


def draw_time(sheet, middle, height, time, margin):
    """The time of a point and, smaller and to its right, how many times as long the next method
    takes, where that is known; centred together."""
    style = {"size": TIME_SIZE, "color": INK, "ha": "center", "va": "center"}
    text = sheet.text(middle, height, seconds(float(f"{time:.2g}")), **style)
    if margin is None:
        return
    width = sheet.text_width(text)
    style = {"size": MARGIN_SIZE, "color": FAINT, "ha": "center", "va": "center"}
    beside = sheet.text(middle, height, f"{times_as_long(margin)}×", **style)
    other, gap = sheet.text_width(beside), 0.07
    text.set_x((middle - (other + gap) / 2) / sheet.width)
    beside.set_x((middle + (width + gap) / 2) / sheet.width)


def draw_cells(sheet, top, row, cells):
    """The cells of a scene: the fastest method, its time below each accuracy; a dash where
    one was asked for and none was found."""
    axes = sheet.axes(cells.left, top, cells.width, cells.row)
    axes.set_xlim(0, len(cells.accuracies))
    axes.set_ylim(0, 1)
    axes.set_axis_off()
    for method, first, last in row.stretches(cells.accuracies):
        look = Look(COLORS[row.kinds[method]], "o", STOCK)
        box = {"facecolor": look.color, "alpha": TINT, "edgecolor": "none"}
        axes.add_patch(Rectangle((first, 0), last - first + 1, 1, **box))
        for edge in (first, last + 1):
            axes.axvline(edge, color="white", linewidth=3)
        room = cells.column * (last - first + 1)
        middle = cells.left + cells.column * first + room / 2
        height = top + cells.name_depth
        draw_name(sheet, middle, height, room, method, look.text_color, cells.two_lines_size)
    for place, accuracy in enumerate(cells.accuracies):
        middle, point = cells.middle(place), row.front.get(accuracy)
        if point:
            margin = row.margins.get(accuracy)
            draw_time(sheet, middle, top + cells.time_depth, point.time, margin)
        elif accuracy in row.accuracies:
            style = {"size": TIME_SIZE, "color": FAINT, "ha": "center", "va": "center"}
            sheet.text(middle, top + cells.row / 2, "–", **style)


def sundials_in_words(row):
    """How many times as long the best of SUNDIALS takes, as median. Also words on the least and the
    most, and on the accuracy below which there is none."""
    ratios = row.ratios.values()
    if not ratios:
        return "", []
    middle, low, high = map(times_as_long, (statistics.median(ratios), min(ratios), max(ratios)))
    more = [f"{low} to {high}"] if low != high else []
    if len(row.ratios) < len(row.front):
        more.append(f"none below {accuracy_in_words(min(row.ratios))}")
    return f"{middle} ×", more


def draw_key(sheet, left, top, right, kinds):
    """The colours of the kinds, side by side, in as many lines as they need; returns how many."""
    place, line = left, 0
    for kind in filter(kinds.__contains__, COLORS):
        box = {"facecolor": COLORS[kind], "alpha": TINT + 0.15, "edgecolor": "none", "pad": 4}
        height = top + KEY_LINE * line
        patch = sheet.text(place + 0.05, height, "     ", size=9, va="center", bbox=box)
        text = sheet.text(place + 0.36, height, kind, size=10, va="center")
        width = 0.36 + sheet.text_width(text)
        if place > left and place + width > right:
            place, line = left, line + 1
            for part, indent in ((patch, 0.05), (text, 0.36)):
                part.set_position(
                    ((left + indent) / sheet.width, 1 - (height + KEY_LINE) / sheet.height)
                )
        place += width + 0.3
    return line + 1 if kinds else 0


def draw_accuracies(sheet, height, cells):
    """The accuracies, in the middle of their columns."""
    for place, accuracy in enumerate(cells.accuracies):
        words = accuracy_in_words(accuracy)
        sheet.text(cells.middle(place), height, words, size=10, ha="center", va="center")


def draw_heads(sheet, bottom, cells, error):
    """The heads of the columns, above `bottom`; `error`: what is at most the accuracy."""
    head, upper, lower = {"size": 10, "va": "center"}, bottom - 0.39, bottom - 0.16
    middle = cells.left + cells.width / 2
    sheet.text(middle, upper, f"{error} at most", ha="center", color=FAINT, **head)
    draw_accuracies(sheet, lower, cells)
    for height, words in ((upper, "SUNDIALS’"), (lower, "best takes")):
        sheet.text(cells.right, height, words, color=FAINT, **head)
