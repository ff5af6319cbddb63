"""The picture of a sweep: the table of the fastest methods, where they change, and what a reader
must know of the numbers."""

import re
from dataclasses import dataclass

from matplotlib import pyplot

from fastest_table import (
    KEY_LINE,
    Cells,
    accuracy_in_words,
    draw_accuracies,
    draw_cells,
    draw_heads,
    draw_key,
    sundials_in_words,
)
from names import shown
from scene_row import counted
from sheet import Sheet
from style import COOL, FAINT, exact, number, seconds

MARGIN = 0.15
ROW, GAP = 0.5, 0.06
LEAST_WIDTH, LEAST_SUNDIALS = 9.2, 0.9
# All columns together are so wide, if none is too narrow or too wide then.
CELLS_WIDTH, LEAST_COLUMN, MOST_COLUMN = 6.4, 1.05, 1.7
# How deep in a row names of methods and times are, and how large a name in two lines may be.
DEPTHS, TWO_LINES_SIZE = (0.165, 0.395), 8
# The accuracies are said again below more rows than this.
MOST_WITH_ONE_HEAD = 20
LEAST_NAMES, MOST_NAMES = 1.5, 2.9
FACT_SIZE, FOOT_SIZE, SUBTITLE_SIZE, CHANGE_SIZE = 8, 8.5, 10.5, 9
LINE, CHANGE_LINE, INDENT = 0.19, 0.2, 0.16
# Sentences on changes, at most.
MOST_CHANGES = 8
# The sizes of a scene's name, and after which letters it may be broken.
ONE_LINE_SIZES, TWO_LINES_SIZES = (10.5, 10, 9.5, 9, 8.5), (8.5, 8, 7.5)
TITLE_STYLE = {"weight": "bold", "va": "center", "linespacing": 1.0}
ENDS = "_-., =+"


@dataclass(frozen=True)
class Study:
    """The contents of a picture: the rows, the number of scenes and of those that cannot be read,
    and sentences on where the fastest method changes. Also whether times are work times costs, the
    processor, and what interrupted the sweep, if anything did."""

    rows: list
    scenes: int
    unreadable: int
    changes: list
    is_work: bool
    processor: str
    interrupted: str | None

    @property
    def judges(self):
        """What the errors of the rows are of."""
        return {"energy" if row.is_by_energy else "position" for row in self.rows}


def value_in_words(along, value):
    """A value of what is varied, with its unit where that is known."""
    if along == "until" and value > 0:
        return seconds(value)
    if abs(value) >= 1e5:
        return number(value)
    return f"{value:,.0f}" if value == round(value) else exact(value)


def common_beginning(low, high, along):
    """What the names of two scenes begin with, in whole words and but for what is varied: "chain"
    of chain_nodes_300 and chain_nodes_1000."""
    words = []
    for left, right in zip(re.split(r"[_\s=,-]+", low), re.split(r"[_\s=,-]+", high)):
        if left != right:
            break
        words.append(left)
    beginning = "_".join(words)
    if beginning != along:
        beginning = beginning.removesuffix(f"_{along}")
    return beginning or f"{low} to {high}"


def change_in_words(crossover):
    """The change of one row, but for the accuracy."""
    first, then = map(shown, crossover.methods)
    scenes = shown(common_beginning(*crossover.scenes, crossover.along))
    along = crossover.along
    if crossover.crossing is None:
        low, high = (value_in_words(along, value) for value in (crossover.low, crossover.high))
        change = f"{first} up to {low}, {then} from {high} on"
    else:
        crossing = value_in_words(along, float(f"{crossover.crossing:.2g}"))
        change = f"{first} up to some {crossing}, then {then}"
    return f"{scenes}, {shown(along)}: {change}"


def listed(words):
    """Words with commas and an "and" between them."""
    return " and ".join([*([", ".join(words[:-1])] if words[1:] else []), *words[-1:]])


def sentences(crossovers):
    """A sentence for each change, in the order of the file, at most MOST_CHANGES of them; then one that
    says how many rows have none. Rows that differ by their accuracy alone share one."""
    changes = {}
    for crossover in crossovers:
        changes.setdefault(change_in_words(crossover), []).append(crossover.accuracy)
    said = [
        f"{change}, at {listed([accuracy_in_words(value) for value in accuracies])}"
        for change, accuracies in list(changes.items())[:MOST_CHANGES]
    ]
    rest = sum(len(accuracies) for accuracies in list(changes.values())[MOST_CHANGES:])
    return [*said, *([f"and {rest} more in crossovers.csv"] if rest else [])]


def in_two(name):
    """A name as two lines, broken at the place nearest to its middle that is good, else there."""
    middle = len(name) / 2
    places = [i + 1 for i, letter in enumerate(name[:-1]) if letter in ENDS]
    # A line that is much the longer one is of no use.
    good = [place for place in places if abs(place - middle) <= len(name) / 6]
    place = min(good, key=lambda place: abs(place - middle)) if good else round(middle)
    return name[:place].rstrip(" "), name[place:].lstrip(" ")


def cut(name, length):
    """A name of at most so many letters; those left out are of its middle."""
    if len(name) <= length:
        return name
    tail = (length - 1) // 2
    return f"{name[: length - 1 - tail]}…{name[len(name) - tail :]}"


def attempts(name):
    """The ways to write a name, the best first: (size, lines)."""
    for size in ONE_LINE_SIZES:
        yield size, (name,)
    for size in TWO_LINES_SIZES:
        yield size, in_two(name)
    for length in range(len(name) - 1, 1, -1):
        yield TWO_LINES_SIZES[-1], in_two(cut(name, length))


def draw_title(sheet, left, height, room, name):
    """Draws the name of a scene in one line or two, centred at a height; returns how many lines."""
    text = sheet.text(left, height, "", **TITLE_STYLE)
    lines = ()
    for size, lines in attempts(name):
        text.set_text("\n".join(map(shown, lines)))
        text.set_size(size)
        if sheet.text_width(text) <= room:
            break
    return len(lines)


def facts(row):
    """What is said of a scene below its name."""
    words = f"{counted(row.nodes, 'node')}, {row.duration}"
    return f"{words}, by energy" if row.is_by_energy else words


def subtitle(study):
    """What the picture shows."""
    rows = len(study.rows)
    where = "on one scene" if rows == 1 else f"on each of {rows} scenes"
    if rows + study.unreadable < study.scenes:
        where = f"on the first {rows} of the {study.scenes} scenes in fastest.csv"
    time = "its time as computed from its work" if study.is_work else "the time of its run"
    most = max(row.methods for row in study.rows)
    next_one = "how many times as long the next one takes"
    return f"the fastest of {most} methods {where}, {time}, and {next_one}"


def foot(study):
    """What a reader must know of the numbers, in paragraphs."""
    core = f"on one core of {study.processor}"
    times = (
        f"Times are computed, not measured: counts of a run’s work, each with what it costs {core}."
        if study.is_work
        else f"Times of whole runs {core}."
    )
    steps = "Steps: the fewest that Verlet can take, T ω/2 at the largest ω."
    by_position = "Errors at the end T, over the largest displacement."
    by_energy = (
        "By energy: the motion is chaotic, and its errors are those of the energy on the way."
    )
    judges = study.judges
    return [
        " ".join([times, *([by_position] if "position" in judges else []), steps]),
        *([by_energy] if "energy" in judges else []),
        "SUNDIALS’ best: how many times as long as the fastest, median over the accuracies, least to"
        " most. –: no run reached it in the time it had.",
        *([left_out(study.unreadable)] if study.unreadable else []),
        *(
            [f"The sweep was interrupted by {study.interrupted}: measurements are missing."]
            if study.interrupted
            else []
        ),
    ]


def left_out(scenes):
    """That so many scenes are not drawn."""
    verb, whose = ("is", "its folder") if scenes == 1 else ("are", "their folders")
    return f"{counted(scenes, 'scene')} of fastest.csv {verb} left out: {whose} cannot be read."


class Plan:
    """Where everything is: measured on a sheet that is thrown away, as the height of a sheet must
    be known before anything is drawn on it."""

    def __init__(self, study):
        accuracies = sorted({key for row in study.rows for key in row.accuracies}, reverse=True)
        column = min(max(CELLS_WIDTH / len(accuracies), LEAST_COLUMN), MOST_COLUMN)
        scratch = Sheet(LEAST_WIDTH, 1.0)
        self.names = self.room_for_names(scratch, study.rows)
        left = MARGIN + self.names + 0.12
        self.cells = Cells(tuple(accuracies), left, column, ROW, *DEPTHS, TWO_LINES_SIZE)
        right = self.cells.right + self.room_for_sundials(scratch, study.rows) + MARGIN
        self.width = max(right, LEAST_WIDTH)
        room = self.width - 2 * MARGIN
        self.subtitle = scratch.filled(subtitle(study).split(), room, size=SUBTITLE_SIZE)
        self.key = 0.76 + 0.2 * len(self.subtitle)
        self.kinds = set().union(*(row.front_kinds for row in study.rows))
        self.top = self.key + 0.7 + KEY_LINE * (self.draw_key(scratch) - 1)
        self.below = self.top + len(study.rows) * (ROW + GAP)
        self.repeats_heads = len(study.rows) > MOST_WITH_ONE_HEAD
        self.changes_top = self.below + (0.3 if self.repeats_heads else 0.12)
        self.changes = [
            line for sentence in study.changes for line in self.hanging(scratch, sentence, room)
        ]
        changes_height = 0.42 + CHANGE_LINE * len(self.changes) if self.changes else 0.0
        self.foot_top = self.changes_top + changes_height
        self.foot = [
            line
            for paragraph in foot(study)
            for line in scratch.filled(paragraph.split(), room, size=FOOT_SIZE)
        ]
        self.height = self.foot_top + LINE * len(self.foot) + 0.12
        pyplot.close(scratch.figure)

    def draw_key(self, sheet):
        """Draws the colours of the kinds; returns how many lines they take."""
        return draw_key(sheet, MARGIN, self.key, self.width - MARGIN, self.kinds)

    @staticmethod
    def room_for_sundials(sheet, rows):
        """How wide what is said of SUNDIALS is."""
        words = (", ".join(sundials_in_words(row)[1]) for row in rows)
        widths = (sheet.text_width(sheet.text(0, 0, line, size=FACT_SIZE)) for line in words)
        return max(LEAST_SUNDIALS, *widths)

    @staticmethod
    def room_for_names(sheet, rows):
        """How wide the names of scenes and what is said below them are, within limits."""
        widths = []
        for row in rows:
            for words, style in (
                (row.title, {"size": ONE_LINE_SIZES[0], "weight": "bold"}),
                (facts(row), {"size": FACT_SIZE}),
            ):
                widths.append(sheet.text_width(sheet.text(0, 0, words, parse_math=False, **style)))
        return min(max(max(widths) + 0.02, LEAST_NAMES), MOST_NAMES)

    @staticmethod
    def hanging(sheet, sentence, room):
        """A sentence in lines, each with its indent: all but the first have one."""
        lines = sheet.filled(sentence.split(), room - INDENT, size=CHANGE_SIZE)
        return [(INDENT if place else 0.0, words) for place, words in enumerate(lines)]


def draw_header(sheet, plan, errors):
    """Title, key and the heads of the columns."""
    sheet.text(MARGIN, 0.27, "Which method, when?", size=16, weight="bold", va="center")
    for line, words in enumerate(plan.subtitle):
        height = 0.6 + 0.2 * line
        sheet.text(MARGIN, height, words, size=SUBTITLE_SIZE, color=FAINT, va="center")
    plan.draw_key(sheet)
    sheet.text(MARGIN, plan.top - 0.16, "scene", size=10, weight="bold", va="center")
    draw_heads(sheet, plan.top, plan.cells, errors)


def draw_scene(sheet, plan, top, row):
    """What is said of a scene, to the left of its cells."""
    lines = draw_title(sheet, MARGIN, top + 0.15, plan.names, row.title)
    height = top + (0.36 if lines == 1 else 0.4)
    sheet.text(MARGIN, height, facts(row), size=FACT_SIZE, color=FAINT, va="center")


def draw_sundials(sheet, plan, top, row):
    """How many times as long the best of SUNDIALS takes, to the right of the cells."""
    left = plan.cells.right
    ratio, more = sundials_in_words(row)
    if not ratio:
        sheet.text(left, top + ROW / 2, "none" if row.front else "–", color=FAINT, va="center")
        return
    height = top + (0.16 if more else ROW / 2)
    style = {"size": 12, "weight": "bold", "color": COOL[0], "va": "center"}
    sheet.text(left, height, ratio, **style)
    words = ", ".join(more)
    sheet.text(left, top + 0.37, words, size=FACT_SIZE, color=FAINT, va="center")


def draw_changes(sheet, plan):
    """Where the fastest method changes, below the cells."""
    words = "Where the fastest method changes"
    sheet.text(MARGIN, plan.changes_top + 0.1, words, size=10, weight="bold", va="center")
    for line, (indent, words) in enumerate(plan.changes):
        height = plan.changes_top + 0.33 + CHANGE_LINE * line
        sheet.text(MARGIN + indent, height, words, size=CHANGE_SIZE, va="center")


def draw(study):
    """The whole picture as a sheet."""
    plan = Plan(study)
    sheet = Sheet(plan.width, plan.height)
    errors = "position error" if study.judges == {"position"} else "error"
    draw_header(sheet, plan, errors)
    for place, row in enumerate(study.rows):
        top = plan.top + place * (ROW + GAP)
        draw_scene(sheet, plan, top, row)
        draw_cells(sheet, top, row, plan.cells)
        draw_sundials(sheet, plan, top, row)
    if plan.repeats_heads:
        draw_accuracies(sheet, plan.below + 0.1, plan.cells)
    if plan.changes:
        draw_changes(sheet, plan)
    for line, words in enumerate(plan.foot):
        height = plan.foot_top + 0.1 + LINE * line
        sheet.text(MARGIN, height, words, size=FOOT_SIZE, color=FAINT, va="center")
    return sheet
