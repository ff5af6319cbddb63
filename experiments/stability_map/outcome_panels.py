"""Small maps of what becomes of a run over step size and amplitude, one a method."""

import math

import numpy as np
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.colors import ListedColormap, to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from outcomes import OUTCOMES, color_of, panels_of, sections_of
from names import shown
from sheet import Sheet
from style import FAINT, INK, number, power_of_ten, short_names

COLUMNS = 4
PANEL, ACROSS, DOWN = 1.8, 0.25, 0.17
LEFT, RIGHT, HEAD, BOTTOM = 0.75, 0.2, 0.53, 0.12
ROW, LEAST_HEIGHT, MOST_HEIGHT = 0.165, 0.5, 1.15
HEADING, LINE, TICKS = 0.34, 0.165, 0.36
NAME_SIZE, NOTE_SIZE, TICK_SIZE, HEAD_SIZE = 9, 8.5, 8.5, 9.5
MOST_TICKS = 7
# A panel of more cells than this is an image in the vector file too.
MOST_SHAPES = 10000

LIMIT = {"color": INK, "linewidth": 1.3, "linestyle": (0, (4, 2))}
BUCKLING = {"color": INK, "linewidth": 1.3, "linestyle": (0, (1, 1.2))}
UNFORESEEN = {"color": INK, "linewidth": 1.3}
# The number of colours and lines of the key in a row, and the heights of the head's rows.
KEYS = 4
SUBTITLE_ROW, KEY_ROW = 0.2, 0.25


def mixed(color, share):
    """The colour on white."""
    return [1 - share * (1 - part) for part in to_rgb(color)]


def edges(values):
    """The borders of the cells around ascending positions: half way between neighbours."""
    middle = [(a + b) / 2 for a, b in zip(values, values[1:])]
    first = values[0] - (middle[0] - values[0] if middle else 0.5)
    last = values[-1] + (values[-1] - middle[-1] if middle else 0.5)
    return [first, *middle, last]


class Cells:
    """The cells of one panel in its axes."""

    def __init__(self, axes, panel, amplitudes):
        self.axes = axes
        self.panel = panel
        self.amplitudes = amplitudes
        self.columns = sorted({run.column for run in panel.runs})
        self.x = edges(self.columns)
        axes.set_xlim(self.x[0], self.x[-1])
        axes.set_ylim(0, len(amplitudes))

    def place(self, run):
        """The column and the row of a run."""
        return self.columns.index(run.column), self.amplitudes.index(run.amplitude)

    def draw(self):
        """The cells, the lines of theory over them and what contradicts it."""
        self.draw_cells()
        self.draw_unfinished()
        self.draw_limit()
        if self.panel.is_swept and not self.panel.limit < math.inf:
            self.draw_buckling()
        self.draw_unforeseen()

    def draw_cells(self):
        """The cells in their colours, white where there is no run or none that finished."""
        image = np.ones((len(self.amplitudes), len(self.columns), 3))
        for run in self.panel.runs:
            i, j = self.place(run)
            image[j, i] = mixed(color_of(run.outcome), run.depth)
        colors, index = np.unique(image.reshape(-1, 3), axis=0, return_inverse=True)
        self.axes.pcolormesh(
            self.x,
            range(len(self.amplitudes) + 1),
            index.reshape(image.shape[:2]),
            cmap=ListedColormap(colors),
            vmin=-0.5,
            vmax=len(colors) - 0.5,
            edgecolors="face",
            linewidth=0.3,
            rasterized=index.size > MOST_SHAPES,
        )

    def draw_unfinished(self):
        """Hatches the cells of runs that were stopped for the time they took."""
        boxes = []
        for run in self.panel.runs:
            if run.outcome == "over_budget":
                i, j = self.place(run)
                boxes.append(Rectangle((self.x[i], j), self.x[i + 1] - self.x[i], 1))
        if boxes:
            style = {"facecolor": "none", "edgecolor": "#B8B8B8", "hatch": "////", "linewidth": 0}
            self.axes.add_collection(PatchCollection(boxes, **style))

    def draw_limit(self):
        """The limit of linear theory."""
        limit = self.panel.limit
        if self.panel.is_swept and 0 < limit < math.inf:
            if self.x[0] < math.log10(limit) < self.x[-1]:
                self.axes.axvline(math.log10(limit), zorder=3, **LIMIT)

    def draw_buckling(self):
        """Where M - h^2 K first is singular at the start, row by row."""
        at = {
            self.amplitudes.index(run.amplitude): math.log10(run.omega_max / run.buckling_rate)
            for run in self.panel.runs
            if run.buckling_rate > 0 and run.omega_max > 0
        }
        at = {j: x for j, x in at.items() if self.x[0] < x < self.x[-1]}
        lines = [[(x, j), (x, j + 1)] for j, x in at.items()]
        lines += [[(x, j + 1), (at[j + 1], j + 1)] for j, x in at.items() if j + 1 in at]
        if lines:
            self.axes.add_collection(LineCollection(lines, zorder=3, **BUCKLING))

    def draw_unforeseen(self):
        """A line around the runs that gained energy against linear theory."""
        inside = {self.place(run) for run in self.panel.runs if self.panel.is_unforeseen(run)}
        sides = []
        for i, j in inside:
            x, y = self.x[i : i + 2], (j, j + 1)
            around = {
                (i - 1, j): [(x[0], y[0]), (x[0], y[1])],
                (i + 1, j): [(x[1], y[0]), (x[1], y[1])],
                (i, j - 1): [(x[0], y[0]), (x[1], y[0])],
                (i, j + 1): [(x[0], y[1]), (x[1], y[1])],
            }
            sides += [side for near, side in around.items() if near not in inside]
        if sides:
            lines = LineCollection(sides, zorder=4, clip_on=False, capstyle="round", **UNFORESEEN)
            self.axes.add_collection(lines)


class OutcomeSheet:
    """The picture of all panels."""

    def __init__(self, runs, limits, origin):
        self.origin = origin
        self.runs = runs
        self.amplitudes = sorted({run.amplitude for run in runs})
        self.sections = sections_of(panels_of(runs, limits))
        self.tall = min(max(ROW * len(self.amplitudes), LEAST_HEIGHT), MOST_HEIGHT)
        width = LEFT + COLUMNS * PANEL + (COLUMNS - 1) * ACROSS + RIGHT
        self.rows = []
        measure = Sheet(width, 1)
        for title, panels in self.sections:
            rows = -(-len(panels) // COLUMNS)
            across = -(-len(panels) // rows)
            chunks = [panels[i : i + across] for i in range(0, len(panels), across)]
            for k, chunk in enumerate(chunks):
                names = [
                    measure.wrapped(short_names(p.methods), PANEL, size=NAME_SIZE, weight="bold")
                    for p in chunk
                ]
                following = len(chunks[k + 1]) if k + 1 < len(chunks) else 0
                self.rows.append((title if k == 0 else None, chunk, names, following))
        words = self.subtitle().split(" ")
        self.words = measure.filled(words, width - 0.3, size=HEAD_SIZE)
        self.keys = self.key_handles()
        lines = -(-len(self.keys) // KEYS)
        self.top = HEAD + SUBTITLE_ROW * len(self.words) + KEY_ROW * lines + 0.25
        height = self.top + BOTTOM + sum(self.height_of(row) for row in self.rows)
        self.sheet = Sheet(width, height)

    def height_of(self, row):
        """The height of a row of panels with its headings."""
        title, chunk, names, following = row
        lines = max(map(len, names)) + 1
        # At the end of a column, ticks use the space of the titles below.
        foot = DOWN if following == len(chunk) else TICKS
        return (HEADING if title else 0) + LINE * lines + self.tall + foot

    def draw(self):
        """Everything."""
        self.draw_header()
        top = self.top
        for row in self.rows:
            title, chunk, names, following = row
            start = top
            if title:
                style = {"size": 10.5, "weight": "bold", "va": "center"}
                self.sheet.text(0.15, top + 0.12, title, **style)
                top += HEADING
            top += LINE * (max(map(len, names)) + 1)
            for i, (panel, lines) in enumerate(zip(chunk, names)):
                left = LEFT + i * (PANEL + ACROSS)
                self.draw_title(left, top, panel, lines)
                axes = self.sheet.axes(left, top, PANEL, self.tall)
                Cells(axes, panel, self.amplitudes).draw()
                self.draw_ticks(axes, panel, i == 0, i >= following)
            top = start + self.height_of(row)

    def draw_title(self, left, top, panel, lines):
        """Names, and under them the limit by theory and by the runs."""
        first = top - 0.07 - LINE * len(lines)
        for k, line in enumerate(lines):
            style = {"size": NAME_SIZE, "weight": "bold", "va": "center"}
            self.sheet.text(left, first + k * LINE, line, **style)
        against = any(panel.is_unforeseen(run) for run in panel.runs)
        color = OUTCOMES["diverged"][1] if against else FAINT
        style = {"size": NOTE_SIZE, "color": color, "va": "center"}
        self.sheet.text(left, top - 0.08, panel.note, **style)

    def draw_ticks(self, axes, panel, is_first, is_last):
        """Amplitudes on the left of a row, step sizes at the foot of a column."""
        for side in axes.spines.values():
            side.set_visible(False)
        axes.tick_params(length=2, color=FAINT, labelsize=TICK_SIZE, pad=2)
        low, high = axes.get_xlim()
        if panel.is_swept:
            places = ticks_between(low, high)
            axes.set_xticks(places, [f"{10**place:.3g}" for place in places])
        else:
            columns = sorted({run.column for run in panel.runs})
            axes.set_xticks(columns, [power_of_ten(10**c) for c in columns])
        if not is_last:
            axes.set_xticklabels([])
        elif is_first:
            words = "h ω_max" if panel.is_swept else "rtol"
            axes.set_xlabel(words, fontsize=TICK_SIZE, labelpad=1)
        every = -(-len(self.amplitudes) // MOST_TICKS)
        rows = range(0, len(self.amplitudes), every)
        words = [number(self.amplitudes[j]) for j in rows] if is_first else [""] * len(rows)
        axes.set_yticks([j + 0.5 for j in rows], words)
        axes.tick_params(axis="y", length=0)
        if is_first:
            words = self.origin.get("vary") or "amplitude"
            axes.set_ylabel(words.replace("_", " "), fontsize=TICK_SIZE, labelpad=3)

    def subtitle(self):
        """What cells and axes are, in words."""
        until, tolerated = self.origin.get("until"), self.origin.get("tolerated")
        length = f"each cell one run of {number(until)} s or 100 steps" if until else ""
        omega = self.origin.get("omega_max")
        across = "to the right h ω_max" + (f" (ω_max {number(omega)} rad/s)" if omega else "")
        up = "upwards the amplitude: 1 is the scene, 0.01 nearly linear"
        if self.origin.get("vary"):
            up = f"upwards {self.origin['vary'].replace('_', ' ')}"
        words = [length, across, up]
        if tolerated:
            words.append(f"bounded: energy within {100 * tolerated:.3g} %")
        return "; ".join(word for word in words if word)

    def draw_header(self):
        """Title, subtitle and the key."""
        scene = self.origin.get("scene", {}).get("name", "the scene")
        title = f"{shown(scene)}: outcome of a run, by method, step size and amplitude"
        lines = [(HEAD + SUBTITLE_ROW * k, HEAD_SIZE, line) for k, line in enumerate(self.words)]
        self.sheet.head(0.15, (0.25, 14, title), *lines)
        self.draw_key(HEAD + SUBTITLE_ROW * len(self.words) + 0.05)
        self.sheet.rule(self.top - 0.12)

    def key_handles(self):
        """All colours and lines that appear, for the key."""
        there = {run.outcome for run in self.runs}
        ordered = [o for o in OUTCOMES if o in there] + sorted(there - set(OUTCOMES))
        keys = []
        for outcome in ordered:
            words = OUTCOMES.get(outcome, (outcome.replace("_", " "),))[0]
            hatch = {"hatch": "/////", "edgecolor": "#B8B8B8", "linewidth": 0}
            hatch = hatch if outcome == "over_budget" else {}
            keys.append(Patch(facecolor=color_of(outcome), label=words, **hatch))
        panels = [panel for _, own in self.sections for panel in own]
        if any(0 < panel.limit < math.inf for panel in panels):
            keys.append(Line2D([], [], label="linear limit", **LIMIT))
        if any(panel.is_unforeseen(run) for panel in panels for run in panel.runs):
            words = "grows against linear theory"
            keys.append(Patch(facecolor="none", edgecolor=INK, linewidth=1.3, label=words))
        if any(run.buckling_rate > 0 for run in self.runs):
            words = "h × buckling rate = 1 at the start"
            keys.append(Line2D([], [], label=words, **BUCKLING))
        return keys

    def draw_key(self, top):
        """The key, in rows."""
        style = {"loc": "center left", "frameon": False, "fontsize": 9, "handlelength": 1.5}
        style |= {"columnspacing": 1.2, "borderaxespad": 0, "borderpad": 0}
        for k in range(0, len(self.keys), KEYS):
            handles = self.keys[k : k + KEYS]
            place = (0.15 / self.sheet.width, 1 - (top + k // KEYS * KEY_ROW) / self.sheet.height)
            self.sheet.figure.legend(
                handles=handles, bbox_to_anchor=place, ncol=len(handles), **style
            )


def ticks_between(low, high):
    """The decades between two logarithms, or, where these are near to each other, what is round
    between them."""
    decades = list(range(math.ceil(low), math.floor(high) + 1))
    if len(decades) > 1:
        return decades
    steps = [step * 10**d for d in range(math.floor(low), math.ceil(high)) for step in (1, 2, 5)]
    inside = [math.log10(step) for step in steps if low <= math.log10(step) <= high]
    return inside if len(inside) > 1 else [low + part * (high - low) for part in (0.15, 0.85)]
