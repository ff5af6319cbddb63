"""Draws how the stiff springs of a scene exchange their energy, by method and step size.

Call: exchange.py DIR, the folder with exchange.csv and summary.csv of the program exchange; writes
DIR/exchange.png and DIR/exchange.svg. A row is a method, a column a step size. Each panel has the
energies of the springs over time, those of the reference in grey, and a verdict.
"""

import sys
from collections import defaultdict

import matplotlib.pyplot as plt

from measurements import read_facts, read_table
from names import shown
from sheet import Sheet, main
from style import COOL, FAINT, GRID, INK, WARM, number

PANEL_WIDTH, PANEL_HEIGHT, ACROSS, DOWN = 2.45, 0.86, 0.12, 0.12
RIGHT, TOP, BOTTOM = 0.25, 1.0, 0.55
# Space for the axis' labels, for each character of the longest method's name, and for title and
# key.
LABELS, CHARACTER, LEAST_WIDTH = 0.45, 0.082, 11.3
REFERENCE_HEIGHT, HEADS = 1.45, 0.3
HIGHEST = 1.45
# If there are more springs, those with the largest energies are drawn.
MOST_SPRINGS = 5
SPRINGS = (COOL[0], WARM[0], COOL[1], WARM[4], COOL[2])
SUM = INK
GREY = "#BBBBBB"
# Colours of a panel and of its words; what the verdicts start with that get it, and what it means.
AS_IT_SHOULD, OFF, BROKEN = ("#DCEBF5", "#004A77"), ("#FBF3CF", "#6B5200"), ("#F9DDD0", "#8E3A00")
LOOKS = (
    ("exchanges as it should", AS_IT_SHOULD),
    ("as it should", AS_IT_SHOULD),
    ("exchanges wrongly", BROKEN),
    ("exchanges", OFF),
)
MEANINGS = (
    (AS_IT_SHOULD, "the energy goes where it should, within 10 % of the time it should take"),
    (OFF, "it goes where it should, and the sum is kept, but sooner or later than that"),
    (BROKEN, "it goes nowhere or elsewhere, or is lost, or grows"),
)


def read(folder):
    """Times and energies by run and spring, and the summary's rows by run: (method, h w)."""
    courses = defaultdict(lambda: defaultdict(lambda: ([], [])))
    for row in read_table(folder / "exchange.csv"):
        times, energies = courses[row["method"], row["h_omega"]][row["spring"]]
        times.append(float(row["t"]))
        energies.append(float(row["energy"] or "inf"))
    rows = read_table(folder / "summary.csv")
    summary = {(row["method"], row["h_omega"]): row for row in rows}
    return courses, summary


def drawn_springs(course):
    """The springs that come to have the most energy, in their order."""
    springs = [name for name in course if name != "sum"]
    springs.sort(key=lambda name: -max(course[name][1]))
    return sorted(springs[:MOST_SPRINGS], key=int)


def look_of(verdict):
    """The colours of the panel with that verdict."""
    return next((look for start, look in LOOKS if verdict.startswith(start)), BROKEN)


class Panels:
    """What all panels have in common."""

    def __init__(self, sheet, reference, until):
        self.sheet = sheet
        self.reference = reference
        self.until = until
        self.springs = drawn_springs(reference)
        self.scale = reference["sum"][1][0]

    def axes(self, left, top, width, height, labelled):
        """An empty panel; labels along the time where asked for."""
        axes = self.sheet.axes(left, top, width, height)
        axes.set(xlim=(0, self.until), ylim=(0, HIGHEST), yticks=(0, 0.5, 1))
        axes.set_xticks([self.until * i / 4 for i in range(4)])
        axes.grid(True, color=GRID, linewidth=0.5)
        axes.tick_params(length=2, color=FAINT, labelsize=8, labelbottom=labelled)
        return axes

    def plot(self, axes, course, name, color, width, order):
        """One line, what is beyond the panel cut off."""
        times, energies = course[name]
        heights = [min(energy / self.scale, 10 * HIGHEST) for energy in energies]
        axes.plot(times, heights, color=color, linewidth=width, zorder=order)

    def draw(self, axes, course, verdict):
        """A run over the reference, and its verdict."""
        face, words = look_of(verdict)
        axes.set_facecolor(face)
        for name in self.springs:
            if course is not self.reference:
                self.plot(axes, self.reference, name, GREY, 0.8, 1.5)
            self.plot(axes, course, name, SPRINGS[self.springs.index(name)], 0.9, 2.5)
        self.plot(axes, course, "sum", SUM, 0.7, 2)
        place = {"transform": axes.transAxes, "ha": "left", "va": "top", "zorder": 5}
        box = {"facecolor": face, "edgecolor": "none", "pad": 1}
        axes.text(0.02, 0.965, verdict, size=8.5, color=words, weight="bold", bbox=box, **place)

    def draw_reference(self, axes):
        """The reference, with what its lines are."""
        names = [*self.springs, "sum"]
        for name, color in zip(names, (*SPRINGS[: len(self.springs)], SUM)):
            self.plot(axes, self.reference, name, color, 0.9, 2)
        place = {"transform": axes.transAxes, "va": "top", "weight": "bold"}
        axes.text(0.02, 0.965, "the exact motion", size=8.5, **place)
        for i, (name, color) in enumerate(zip(names, (*SPRINGS[: len(self.springs)], SUM))):
            label = "sum" if name == "sum" else f"$I_{{{int(name) + 1}}}$"
            axes.text(1.02, 0.9 - 0.19 * i, label, size=10.5, color=color, **place)


def draw_meanings(sheet, left, top):
    """What the panels' colours mean."""
    for i, ((face, words), meaning) in enumerate(MEANINGS):
        axes = sheet.axes(left, top + 0.36 * i, 0.32, 0.2)
        axes.set(facecolor=face, xticks=(), yticks=())
        axes.spines[:].set_visible(False)
        middle = top + 0.36 * i + 0.1
        sheet.text(left + 0.42, middle, meaning, size=9.5, color=words, va="center")


def forces(method, summary):
    """How many forces a step of the method takes, at the shortest step that reached the end."""
    rows = [row for run, row in summary.items() if run[0] == method and int(row["steps"]) > 0]
    if not rows:
        return ""
    row = min(rows, key=lambda row: (row["outcome"] != "reached_end", float(row["h"])))
    count = round(int(row["force_evaluations"]) / int(row["steps"]))
    return f"{count} force{'' if count == 1 else 's'} a step"


def draw(folder):
    """Draws the picture."""
    plt.rcParams["path.simplify_threshold"] = 0.6
    courses, summary = read(folder)
    origin = read_facts(folder / "summary.json")
    runs = [run for run in summary if run[0] != "reference"]
    if not runs:
        sys.exit(f"exchange.py: {folder} has no run to draw")
    methods = list(dict.fromkeys(method for method, _ in runs))
    steps = list(dict.fromkeys(step for _, step in runs))
    reference = next(course for run, course in courses.items() if run[0] == "reference")
    start = LABELS + CHARACTER * max(len(method) for method in methods)
    width = start + len(steps) * (PANEL_WIDTH + ACROSS) - ACROSS + RIGHT
    width = max(width, LEAST_WIDTH)
    first = TOP + REFERENCE_HEIGHT + 0.35 + HEADS
    height = first + len(methods) * (PANEL_HEIGHT + DOWN) - DOWN + BOTTOM
    sheet = Sheet(width, height)
    panels = Panels(sheet, reference, origin["until"])
    title = (
        f"{shown(origin['scene']['name'])}: which method lets stiff springs exchange their energy?"
    )
    words = (
        f"energies of stiff springs over time, in parts of their sum at the start; "
        f"ω = {number(origin['omega'])} rad/s, that of the stiff springs alone; grey: the exact "
        "motion"
    )
    sheet.head(0.2, (0.3, 15, title), (0.62, 10, words))
    sheet.rule(0.82)
    axes = panels.axes(start, TOP, PANEL_WIDTH, REFERENCE_HEIGHT, True)
    panels.draw_reference(axes)
    draw_meanings(sheet, start + PANEL_WIDTH + 0.75, TOP + 0.2)
    for i, step in enumerate(steps):
        middle = start + i * (PANEL_WIDTH + ACROSS) + PANEL_WIDTH / 2
        label = f"h ω = {float(step):g}"
        sheet.text(middle, first - 0.14, label, size=11, weight="bold", ha="center", va="center")
    for row, method in enumerate(methods):
        top = first + row * (PANEL_HEIGHT + DOWN)
        middle = top + PANEL_HEIGHT / 2
        place = {"ha": "right", "va": "center"}
        sheet.text(start - 0.35, middle - 0.09, method, size=10, color=INK, **place)
        work = forces(method, summary)
        sheet.text(start - 0.35, middle + 0.11, work, size=8.5, color=FAINT, **place)
        for i, step in enumerate(steps):
            if (method, step) not in summary:
                continue  # the study was interrupted before
            left = start + i * (PANEL_WIDTH + ACROSS)
            axes = panels.axes(left, top, PANEL_WIDTH, PANEL_HEIGHT, row + 1 == len(methods))
            axes.tick_params(labelleft=i == 0)
            if row + 1 == len(methods):
                axes.set_xlabel("t in s", fontsize=9, labelpad=1)
            panels.draw(axes, courses[method, step], summary[method, step]["verdict"])
    sheet.save_as(folder, "exchange")


if __name__ == "__main__":
    main(draw)
