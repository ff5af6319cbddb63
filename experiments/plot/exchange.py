"""Draws how the stiff springs of a scene exchange their energy, by method and step size.

Call: exchange.py DIR, the folder with exchange.csv and summary.csv of the program exchange; writes
DIR/exchange.png and DIR/exchange.svg. A row is a method, a column a step size; each panel has the
energies of the springs over time, what they are in the reference in grey, and a verdict.
"""

import csv
import json
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib.pyplot as plt

from sheet import Sheet
from style import COOL, FAINT, GRID, INK, WARM, number, use_style

PANEL_WIDTH, PANEL_HEIGHT, ACROSS, DOWN = 2.45, 0.86, 0.12, 0.12
LEFT, RIGHT, TOP, BOTTOM = 1.65, 0.25, 1.0, 0.55
REFERENCE_HEIGHT, HEADS = 1.45, 0.3
HIGHEST = 1.45
# Of more springs than that, those are drawn that come to have the most energy.
MOST_SPRINGS = 5
SPRINGS = (COOL[0], WARM[0], COOL[1], WARM[4], COOL[2])
SUM = INK
GREY = "#BBBBBB"
# What a verdict starts with, and the colours of its panel and of its words; else it is BROKEN.
RIGHT_LOOK = ("#DCEBF5", "#004A77")
LOOKS = (
    ("exchanges as it should", RIGHT_LOOK),
    ("exchanges wrongly", ("#F9DDD0", "#8E3A00")),
    ("exchanges", ("#FBF3CF", "#6B5200")),
)
BROKEN = ("#F9DDD0", "#8E3A00")


def read(folder):
    """Times and energies by run and spring, and the summary's rows by run: (method, h w)."""
    courses = defaultdict(lambda: defaultdict(lambda: ([], [])))
    with open(folder / "exchange.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            times, energies = courses[row["method"], row["h_omega"]][row["spring"]]
            times.append(float(row["t"]))
            energies.append(float(row["energy"] or "inf"))
    with open(folder / "summary.csv", newline="", encoding="utf-8") as file:
        summary = {(row["method"], row["h_omega"]): row for row in csv.DictReader(file)}
    return courses, summary


def drawn_springs(course):
    """The springs that come to have the most energy, in their order."""
    springs = [name for name in course if name != "sum"]
    springs.sort(key=lambda name: -max(course[name][1]))
    return sorted(springs[:MOST_SPRINGS], key=int)


def look_of(verdict):
    """The colours of a panel and of its words."""
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
        axes.text(0.02, 0.965, verdict, size=8.5, color=words, weight="bold", **place)

    def draw_reference(self, axes):
        """The reference, each line named beside it."""
        self.draw(axes, self.reference, "the exact motion")
        axes.set_facecolor("white")
        for i, name in enumerate([*self.springs, "sum"]):
            color = SUM if name == "sum" else SPRINGS[i]
            label = "sum" if name == "sum" else f"$I_{{{int(name) + 1}}}$"
            axes.text(
                1.03 + 0.11 * (i % 3),
                0.75 - 0.25 * (i // 3),
                label,
                transform=axes.transAxes,
                color=color,
                size=11,
                weight="bold",
                va="center",
            )


def main(folder):
    """Draws the picture."""
    use_style()
    plt.rcParams["path.simplify_threshold"] = 0.6
    folder = Path(folder)
    courses, summary = read(folder)
    origin = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    runs = [run for run in summary if run[0] != "reference"]
    methods = list(dict.fromkeys(method for method, _ in runs))
    steps = list(dict.fromkeys(step for _, step in runs))
    reference = next(course for run, course in courses.items() if run[0] == "reference")
    width = LEFT + len(steps) * (PANEL_WIDTH + ACROSS) - ACROSS + RIGHT
    first = TOP + REFERENCE_HEIGHT + 0.35 + HEADS
    height = first + len(methods) * (PANEL_HEIGHT + DOWN) - DOWN + BOTTOM
    sheet = Sheet(width, height)
    panels = Panels(sheet, reference, origin["until"])
    title = f"{origin['scene']['name']}: which method lets stiff springs exchange their energy?"
    sheet.text(0.2, 0.3, title, size=15, weight="bold", va="center", color=INK)
    words = (
        f"energies of stiff springs over time, in parts of their sum at the start; "
        f"ω = {number(origin['omega'])} rad/s, that of the stiff springs alone; grey: the exact "
        "motion"
    )
    sheet.text(0.2, 0.62, words, size=10, color=FAINT, va="center")
    sheet.rule(0.82)
    axes = panels.axes(LEFT, TOP, PANEL_WIDTH, REFERENCE_HEIGHT, True)
    panels.draw_reference(axes)
    for i, step in enumerate(steps):
        middle = LEFT + i * (PANEL_WIDTH + ACROSS) + PANEL_WIDTH / 2
        label = f"h ω = {float(step):g}"
        sheet.text(middle, first - 0.14, label, size=11, weight="bold", ha="center", va="center")
    for row, method in enumerate(methods):
        top = first + row * (PANEL_HEIGHT + DOWN)
        middle = top + PANEL_HEIGHT / 2
        sheet.text(LEFT - 0.35, middle, method, size=10, ha="right", va="center", color=INK)
        for i, step in enumerate(steps):
            left = LEFT + i * (PANEL_WIDTH + ACROSS)
            axes = panels.axes(left, top, PANEL_WIDTH, PANEL_HEIGHT, row + 1 == len(methods))
            axes.tick_params(labelleft=i == 0)
            if row + 1 == len(methods):
                axes.set_xlabel("t in s", fontsize=9, labelpad=1)
            panels.draw(axes, courses[method, step], summary[method, step]["verdict"])
    for extension in ("png", "svg"):
        sheet.save(str(folder / f"exchange.{extension}"))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("Usage: exchange.py DIR")
    main(sys.argv[1])
