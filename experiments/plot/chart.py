"""The axes of a work-precision chart: lines, front, certified floor and the labels."""

from itertools import groupby

from matplotlib import ticker

from labels import Ink, line_label, move_labels
from record import sweeps
from style import FAINT, FRONT, power_of_ten, seconds, widened

FONT_SIZE = 9.5
FRONT_INK = 0.5
BELOW_TICKS = -28


class Chart:
    """The runs of one experiment in axes of error and time, each as an emphasis strokes it."""

    def __init__(self, axes, view, emphasis):
        self.axes = axes
        self.view = view
        self.sweeps = sweeps(view.runs)
        self.good = [run for run in view.runs if not run.failure]
        self.looks = emphasis.looks
        self.strokes = {
            (sweep[0].method, sweep[0].knob): emphasis.stroke(view, sweep) for sweep in self.sweeps
        }
        self.smallest = view.smallest
        self.set_limits()
        self.style_axes()

    def stroke(self, sweep):
        """How the line of a sweep is drawn."""
        return self.strokes[sweep[0].method, sweep[0].knob]

    def set_limits(self):
        """The ranges of error and time; the floor is in them where the errors come
        near."""
        errors = [self.position(run)[0] for run in self.good] or [1e-9, 1.0]
        times = [run.time for run in self.good] or [1e-3, 1.0]
        self.floor_visible = bool(self.view.floor) and min(errors) < 1e3 * self.view.floor
        left = self.view.floor / 5 if self.floor_visible else min(errors) / 3
        right = max(errors) * 3
        self.axes.set_xscale("log")
        self.axes.set_yscale("log")
        self.axes.set_xlim(*widened(left, right, 2))
        self.axes.set_ylim(*widened(min(times) / 2.2, max(times) * 2, 2))

    def style_axes(self):
        """Grid, ticks and the directions in which a method is better."""
        for axis, words in ((self.axes.xaxis, power_of_ten), (self.axes.yaxis, seconds)):
            axis.set_major_locator(ticker.LogLocator(numticks=12))
            axis.set_minor_locator(ticker.LogLocator(numticks=50))
            axis.set_major_formatter(ticker.FuncFormatter(lambda v, _, words=words: words(v)))
            axis.set_minor_formatter(ticker.NullFormatter())
        self.axes.grid(True, which="both")
        self.axes.tick_params(length=3, color=FAINT, labelsize=FONT_SIZE)
        self.axes.tick_params(which="minor", length=0)
        self.axes.set_ylabel("time of one run, median", fontsize=10)
        self.note(self.view.quantity.axis, 0.5, (0, BELOW_TICKS), ha="center", va="center")
        self.note("◀ more accurate", 0, (0, BELOW_TICKS), va="center", weight="bold")
        self.note("◀ faster", 0, (-51, 0), rotation=90, ha="center", va="bottom", weight="bold")

    def note(self, words, x, offset, **style):
        """Words at the foot of the axes: at a share of their width, moved by an offset in
        points."""
        self.axes.annotate(
            words,
            (x, 0),
            offset,
            xycoords="axes fraction",
            textcoords="offset points",
            **{"size": 10, **style},
        )

    def position(self, run):
        """Where a run is drawn: one below the floor stands on it."""
        return self.view.drawn_error(run), run.time

    def draw(self):
        """Draws everything; the labels come last, when all they must not hide is known."""
        self.draw_floor()
        if self.floor_visible and any(run.is_uncertain for run in self.good):
            words = "bars: error ± error bound of the reference"
            style = {"size": 9.5, "color": FAINT, "ha": "right", "va": "center"}
            self.note(words, 1, (0, BELOW_TICKS), **style)
        if any(run.is_lucky for run in self.good):
            words = "× small by luck: counts as a finer run does"
            box = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
            style = {"size": 9.5, "color": FAINT, "ha": "center", "va": "bottom", "bbox": box}
            self.note(words, 0.5, (0, 6), **style)
        self.draw_chaos()
        self.draw_front()
        for sweep in self.sweeps:
            self.draw_sweep(sweep)
        if self.good:
            self.draw_labels()
        else:
            words = "no run gave a point"
            middle = {"transform": self.axes.transAxes, "ha": "center", "va": "center"}
            self.axes.text(0.5, 0.5, words, size=13, color=FAINT, **middle)

    def draw_floor(self):
        """The region of errors below what the reference solution can tell, or a note that it lies
        beyond the axes."""
        if not self.view.floor:
            return
        words = self.view.floor_words
        if any(run.error < self.view.floor for run in self.good):
            words += ", smaller errors stand on the line"
        style = {"size": 9.5, "color": FAINT, "ha": "right"}
        if not self.floor_visible:
            self.note(words, 1, (0, BELOW_TICKS), va="center", **style)
            return
        left = self.axes.get_xlim()[0]
        self.axes.axvspan(
            left, self.view.floor, facecolor="none", edgecolor="#BBBBBB", hatch="////", linewidth=0
        )
        self.draw_upright(words, self.view.floor)

    def draw_upright(self, words, error, linestyle="-", zorder=3):
        """A line at an error, with words beside its foot."""
        self.axes.axvline(error, color=FAINT, linewidth=1.0, linestyle=linestyle)
        self.axes.annotate(
            words,
            (error, 0),
            (-8, 6),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            rotation=90,
            size=9.5,
            color=FAINT,
            ha="right",
            va="bottom",
            zorder=zorder,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
        )

    def draw_chaos(self):
        """The line below which errors depend on how a method rounds, where the motion is
        chaotic."""
        if self.view.chaotic_below:
            self.draw_upright("chaotic: rounding decides", self.view.chaotic_below, ":", 4)

    def front_corners(self):
        """The staircase of the shortest time that reaches each error or a smaller one."""
        corners = []
        for run in reversed(self.view.staircase):
            # An error is known to be reached if the run counts at it or at a smaller one.
            error = max(run.counts_at, self.smallest)
            corners += [(error, corners[-1][1])] if corners else []
            corners.append((error, run.time))
        return corners + [(self.axes.get_xlim()[1], corners[-1][1])] if corners else []

    def draw_front(self):
        """The front as a wide stroke under the lines."""
        corners = self.front_corners()
        if corners:
            self.axes.plot(
                *zip(*corners),
                color=FRONT,
                alpha=0.75,
                linewidth=9,
                solid_joinstyle="round",
                solid_capstyle="round",
                zorder=1.5,
            )

    def pieces(self, sweep):
        """The points of a sweep, parted where runs between them failed."""
        for failed, runs in groupby(sweep, key=lambda run: bool(run.failure)):
            if not failed:
                yield [self.position(run) for run in runs]

    def draw_sweep(self, sweep):
        """The line of one method, a hairline where runs between its points failed."""
        stroke = self.stroke(sweep)
        style = {"color": stroke.color, "alpha": stroke.alpha}
        pieces = list(self.pieces(sweep))
        for piece in pieces:
            self.axes.plot(*zip(*piece), **stroke.line, **style, **stroke.marker)
        for before, after in zip(pieces, pieces[1:]):
            self.axes.plot(*zip(before[-1], after[0]), linewidth=0.6, zorder=2, **style)
        self.draw_doubts(sweep, style)
        lucky = [self.position(run) for run in sweep if run.is_lucky and not run.failure]
        if lucky:
            self.axes.plot(*zip(*lucky), linestyle="", marker="x", markersize=13, **style)

    def draw_doubts(self, sweep, style):
        """Draws the range of a run's error, from its lower to its upper bound, if these are
        apart."""
        for run in sweep if self.view.floor else []:
            if run.failure or not run.is_uncertain:
                continue
            left, right = max(run.at_least, self.axes.get_xlim()[0]), run.at_most
            self.axes.plot([left, right], [run.time] * 2, linewidth=0.9, zorder=2.2, **style)

    def pixels(self, position):
        """A point of the axes in pixels."""
        return tuple(self.axes.transData.transform(position))

    def ink(self, bounds):
        """What the labels should not hide; the front bears a label better than a line does."""
        ink = Ink(bounds)
        corners = [self.pixels(corner) for corner in self.front_corners()]
        for start, end in zip(corners, corners[1:]):
            ink.add_line(start, end, FRONT_INK)
        for sweep in self.sweeps:
            weight = self.stroke(sweep).ink
            for piece in self.pieces(sweep):
                points = [self.pixels(position) for position in piece]
                for point in points:
                    ink.add_marker(point, weight)
                for start, end in zip(points, points[1:]):
                    ink.add_line(start, end, weight)
        return ink

    def label_of(self, sweep):
        """The name of a line: the method, with the knob where the method has several."""
        method, knob = sweep[0].method, sweep[0].knob
        several = sum(other[0].method == method for other in self.sweeps) > 1
        return f"{method} ({knob})" if several else method

    def label_bounds(self):
        """The pixels the labels may take: the axes without the floor."""
        box = self.axes.bbox
        left = self.pixels((self.smallest, 1))[0] + 3 if self.floor_visible else box.x0 + 3
        return left, box.y0 + 3, box.x1 - 3, box.y1 - 3

    def draw_labels(self):
        """Names the lines that have a label at one of their ends."""
        named = [sweep for sweep in self.sweeps if self.stroke(sweep).label_size]
        lines = [sweep for sweep in named if any(not run.failure for run in sweep)]
        ends, texts, positions = [], [], {}
        for sweep in lines:
            good = [self.position(run) for run in sweep if not run.failure]
            ends.append({self.pixels(end): end for end in (good[0], good[-1])})
            positions |= ends[-1]
            look, stroke = self.looks[sweep[0].method], self.stroke(sweep)
            style = {"white": 0.8, "alpha": stroke.label_alpha}
            style["leader"] = {"alpha": stroke.alpha, "shrinkB": 4}
            size, colors = stroke.label_size, (look.color, look.text_color)
            texts.append(line_label(self.axes, self.label_of(sweep), *colors, size, **style))
        move_labels(texts, ends, self.ink(self.label_bounds()), positions.get)
