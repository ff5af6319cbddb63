"""Panels with the damping of an oscillator and of a scene's natural modes by fixed-step methods,
and with the steps of adaptive methods."""

import math
from dataclasses import dataclass

from matplotlib import ticker
from matplotlib.lines import Line2D

from labels import ink_within, label_lines
from names import shown
from sheet import Sheet
from style import COOL, FAINT, GRID, INK, MARKERS, WARM, Family, Look, log_ticks, number
from style import short_names

WIDTH = 8.9
LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT = 0.8, 1.45, 7.0, 3.65
# Inches below a panel for its axis' words, and for the heading of the next part.
FOOT, HEADING = 0.6, 0.55
TABLE, TABLE_END, LINE, GAP = 0.25, 8.65, 0.18, 0.06
LIMIT_AT, DIFFERENCE_AT = 7.5, TABLE_END
# The names and the shares of rejected steps beside the dots, and the height of a row of dots.
NAMES, REJECTED, DOT_ROW = 1.35, 0.75, 0.215
SIZE = 9
COLORS = tuple(color for pair in zip(WARM, COOL) for color in pair)
# Curves that are nearer than this to each other count as one.
SAME = 1e-6
# Damping ratios are drawn linearly below this, logarithmically above.
STRAIGHT = 1e-3
UNDAMPED = 1e-4
# A mode "lives" up to the first damping ratio: it loses half of its energy in ten periods. It is
# "killed" from the second on: it loses nine tenths of its amplitude in one period.
LIVING, KILLING = math.log(2) / (40 * math.pi), math.log(10) / (2 * math.pi)
ZONES = (
    ("killed", KILLING, 1.6, "#BBD8EC"),
    ("damped", LIVING, KILLING, "#DDEAF4"),
    ("lives", 0.0, LIVING, "#E6EEE4"),
    ("blows up", -1.6, 0.0, "#F6DDD9"),
)
TICKS = (-1, -0.1, -0.01, 0, 0.01, 0.1, 1)
# Labels stand where their curve is neither undamped nor dies or grows as fast as all others.
LEAST_AWAY, MOST_AWAY, MOST_ANCHORS, APART = 2e-3, 0.9, 14, 20
RTOL = 1e-4
FREQUENCY_COLORS = ("#9CC8E6", "#5B9BD0", "#2A6CA8", "#12375E")


@dataclass
class Curve:
    """Methods of one damping over h w. limits: of each, predicted and measured."""

    methods: list
    points: list
    limits: list
    look: Look

    @property
    def line(self):
        """How it is drawn."""
        return {"color": self.look.color, "linewidth": 1.7, "zorder": 3}

    @property
    def name(self):
        """The first method and how many others there are."""
        others = len(self.methods) - 1
        return f"{self.methods[0]} (+{others})" if others else self.methods[0]

    def is_like(self, points, limits):
        """Whether another method's curve and limit are the same."""
        return alike(self.limits[0][0], limits[0], rel_tol=1e-6) and all(
            math.isclose(x, u) and alike(y, v, rel_tol=0, abs_tol=SAME)
            for (x, y), (u, v) in zip(self.points, points)
        )

    def between(self, low, high):
        """Its points from one h w to another that have a damping."""
        return [(x, y) for x, y in self.points if low <= x <= high and not math.isnan(y)]


def own_damping(modes):
    """The damping of a scene's modes themselves, as (frequency in Hz, damping ratio) in ascending
    order; empty where it has none."""
    ratios = {
        (row["omega"] / (2 * math.pi), float(row["damping_ratio_physical"]))
        for row in modes
        if row.get("damping_ratio_physical")
    }
    return sorted(ratios) if any(zeta > 0 for _, zeta in ratios) else []


def alike(a, b, **tolerance):
    """Whether two numbers are one, or neither is known."""
    return math.isclose(a, b, **tolerance) or math.isnan(a) and math.isnan(b)


def curves_of(linear, limits):
    """The curves in the order of the methods; linear: for each method h w and damping ratio."""
    curves = []
    for method, points in linear.items():
        own = limits.get(method, (math.nan, math.nan))
        like = next((c for c in curves if c.is_like(points, own)), None)
        if like:
            like.methods.append(method)
            like.limits.append(own)
            continue
        i = len(curves)
        family = Family("", COLORS, "-", False)
        look = Look(COLORS[i % len(COLORS)], MARKERS[i % len(MARKERS)], family)
        curves.append(Curve([method], points, [own], look))
    return curves


def style_axes(axes):
    """Zones, grid and scales of damping over a logarithmic axis."""
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=STRAIGHT, linscale=0.35)
    axes.set_ylim(-1.6, 1.6)
    axes.set_yticks(TICKS, [f"{tick:g}" for tick in TICKS])
    axes.yaxis.set_minor_locator(ticker.NullLocator())
    log_ticks(axes.xaxis, 9, "{:g}".format)
    axes.tick_params(length=3, color=FAINT, labelsize=9)
    for words, low, high, color in ZONES:
        axes.axhspan(low, high, facecolor=color, zorder=0)
        foot, head = axes.transData.transform([(1, low), (1, high)])[:, 1]
        middle = axes.transAxes.inverted().transform((0, (foot + head) / 2))[1]
        style = {"transform": axes.transAxes, "va": "center", "size": 9.5, "color": INK}
        axes.text(1.01, middle, words, weight="bold", **style)
    axes.axhline(0, color=FAINT, linewidth=0.8, zorder=1)
    axes.set_ylabel("damping ratio", fontsize=10)


def anchors_of(axes, pixels):
    """The places on its curve where a label may stand: where the curve is apart from others or, if
    it nowhere is, at its highest or lowest point."""
    dense = pixels[:1]
    for (x, y), (u, v) in zip(pixels, pixels[1:]):
        parts = range(1, 2 + int(math.hypot(u - x, v - y) / APART))
        dense += [(x + (u - x) * i / len(parts), y + (v - y) * i / len(parts)) for i in parts]
    levels = [(1, y) for y in (-MOST_AWAY, -LEAST_AWAY, 0, LEAST_AWAY, MOST_AWAY)]
    lowest, low, zero, high, highest = axes.transData.transform(levels)[:, 1]
    away = [p for p in dense if lowest < p[1] < low or high < p[1] < highest]
    away = away or [max(dense, key=lambda p: abs(p[1] - zero))]
    return away[:: max(1, -(-len(away) // MOST_ANCHORS))]


def label_curves(axes, named, marks=()):
    """Names each list of points near one of them, off the others and off the marks; named:
    (words, look, points)."""
    ink = ink_within(axes)
    left, _, right, _ = ink.bounds
    zero = axes.transData.transform((axes.get_xlim()[0], 0))[1]
    ink.add_line((left, zero), (right, zero), 3.0)
    for mark in marks:
        ink.add_marker(axes.transData.transform(mark))
    lines = [(words, look.color, look.text_color, points) for words, look, points in named]
    label_lines(axes, lines, lambda pixels: anchors_of(axes, pixels), ink)


class DampingSheet:
    """The picture. modes: the rows of modal.csv, chosen: those of adaptive.csv, as dictionaries."""

    def __init__(self, linear, limits, modes, chosen, origin):
        self.origin = origin
        self.curves = curves_of(linear, limits)
        self.modes = modes
        self.chosen = chosen
        measure = Sheet(WIDTH, 1)
        room = LIMIT_AT - 1.45 - TABLE - 0.36
        self.names = [
            measure.wrapped(short_names(curve.methods), room, size=SIZE) for curve in self.curves
        ]
        self.sheet = Sheet(WIDTH, self.height())

    def heights(self):
        """The heights of the parts that there are: table, modes, and steps chosen by methods."""
        chosen = self.chosen_rows()
        count = len({row["method"] for row in chosen})
        return {
            "table": sum(LINE * len(words) + GAP for words in self.names) + 0.1,
            "modes": PANEL_HEIGHT + FOOT if self.modes else 0,
            "chosen": DOT_ROW * count + FOOT if chosen else 0,
        }

    def height(self):
        """The sheet's height."""
        parts = [part for part in self.heights().values() if part]
        return TOP + PANEL_HEIGHT + FOOT + sum(parts) + HEADING * len(parts)

    def draw(self):
        """Everything."""
        scene = self.origin.get("scene", {}).get("name", "the scene")
        title = f"{shown(scene)}: what methods do to vibrations"
        words = (
            (0.53, 9.5, "lives: keeps half of its energy for ten periods and more; blows up: grows"),
            (0.73, 9.5, "killed: loses nine tenths of its amplitude in a period"),
        )
        self.sheet.head(0.15, (0.25, 14, title), *words)
        self.sheet.rule(0.9)
        self.draw_linear()
        heights = self.heights()
        top = TOP + PANEL_HEIGHT + FOOT + HEADING
        self.draw_table(top)
        top += heights["table"] + HEADING
        if self.modes:
            self.draw_modes(top)
            top += heights["modes"] + HEADING
        if heights["chosen"]:
            self.draw_chosen(top)

    def heading(self, left, top, words, note=""):
        """What a part shows: in bold, and more of it below."""
        self.sheet.text(left, top - 0.36, words, size=10.5, weight="bold", va="center")
        self.sheet.text(left, top - 0.15, note, size=SIZE, color=FAINT, va="center")

    def draw_linear(self):
        """Damping over h w, with the limits."""
        note = "lines found by running each method; circles: where by theory it first grows"
        self.heading(LEFT, TOP, "An oscillator of frequency ω, step size h", note)
        axes = self.sheet.axes(LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT)
        every = [x for curve in self.curves for x, _ in curve.points]
        axes.set_xlim(min(every), max(every))
        style_axes(axes)
        axes.set_xlabel("h ω", fontsize=10, labelpad=2)
        named = []
        for curve in self.curves:
            points = curve.between(0, math.inf)
            if not points:
                continue
            axes.plot(*zip(*points), **curve.line)
            limit = curve.limits[0][0]
            if axes.get_xlim()[0] < limit < axes.get_xlim()[1]:
                style = {"markerfacecolor": "white", "markeredgecolor": curve.look.color}
                axes.plot([limit], [0], "o", markersize=5.5, zorder=5, mew=1.5, **style)
            named.append((curve.name, curve.look, points))
        label_curves(axes, named)

    def draw_table(self, top):
        """The methods of each curve and their limits."""
        self.heading(TABLE, top, "Methods of one curve, and the largest stable h ω")
        style = {"size": SIZE, "color": FAINT, "va": "center", "ha": "right"}
        self.sheet.text(LIMIT_AT, top - 0.15, "theory", **style)
        self.sheet.text(DIFFERENCE_AT, top - 0.15, "measured", **style)
        top += 0.08
        for curve, words_of_curve in zip(self.curves, self.names):
            line = Line2D(
                [(TABLE + part) / WIDTH for part in (0, 0.14, 0.28)],
                [1 - top / self.sheet.height] * 3,
                color=curve.look.color,
                linewidth=1.8,
                markevery=[1],
                **curve.look.marker_style(4.8),
            )
            self.sheet.figure.add_artist(line)
            style = {"size": SIZE, "va": "center"}
            predicted, _ = curve.limits[0]
            words = {0: "grows at every h", math.inf: "none"}.get(predicted)
            words = words or ("unknown" if math.isnan(predicted) else f"{predicted:.6f}")
            self.sheet.text(LIMIT_AT, top, words, ha="right", **style)
            self.sheet.text(DIFFERENCE_AT, top, difference(curve), ha="right", **style)
            for words in words_of_curve:
                color = curve.look.text_color
                self.sheet.text(TABLE + 0.36, top, words, color=color, **style)
                top += LINE
            top += GAP

    def draw_modes(self, top):
        """Damping over the frequencies of the scene: lines predicted, marks measured."""
        h = self.modes[0]["h"]
        fastest = max(row["h_omega"] for row in self.modes)
        axes = self.sheet.axes(LEFT, top, PANEL_WIDTH, PANEL_HEIGHT)
        frequencies = [row["omega"] / (2 * math.pi) for row in self.modes]
        axes.set_xlim(min(frequencies) / 1.4, max(frequencies) * 1.4)
        style_axes(axes)
        if max(frequencies) < 30 * min(frequencies):
            log_ticks(axes.xaxis, 9, "{:g}".format, subs=(1, 2, 5))
        axes.set_xlabel("natural frequency in Hz", fontsize=10, labelpad=2)
        named, all_marks, apart, unmeasured = [], [], 0.0, {}
        physical = own_damping(self.modes)
        if physical:
            axes.plot(*zip(*physical), color=INK, linewidth=5, alpha=0.3, zorder=2)
        for curve in self.curves:
            rows = [row for row in self.modes if row["method"] in curve.methods]
            if not rows:
                continue
            points = self.predicted(curve, rows, h)
            if points:
                axes.plot(*zip(*points), **curve.line)
            seen = [row for row in rows if not math.isnan(row["damping_ratio_measured"])]
            for row in rows:
                if row not in seen:
                    unmeasured[row["method"]] = row["verdict"]
            ends = ((r["damping_ratio_measured"], r["damping_ratio_predicted"]) for r in seen)
            apart = max([apart, *(abs(m - p) for m, p in ends if not math.isnan(p))])
            marks = [(row["omega"] / (2 * math.pi), row["damping_ratio_measured"]) for row in seen]
            all_marks += marks
            if marks:
                axes.plot(*zip(*marks), linestyle="", zorder=4, **curve.look.marker_style(4.8))
            if points and max(abs(y) for _, y in points + marks) > UNDAMPED:
                named.append((curve.name, curve.look, sorted(points)))
        note = "lines predicted, marks measured by exciting the mode: "
        note += f"apart by at most {number(apart)}"
        if physical:
            note += "; broad grey line: the damping of the scene itself"
        words = f"The scene's own modes at h = {number(h)} s (h ω up to {number(fastest)})"
        self.heading(LEFT, top, words, note)
        label_curves(axes, named, all_marks)
        if unmeasured:
            words = f"{len(unmeasured)} methods are not measured in all modes (modal.csv says why)"
            axes.text(0.01, 0.02, words, transform=axes.transAxes, size=SIZE, color=FAINT)

    def predicted(self, curve, rows, h):
        """The line of a curve over the frequencies of the modes, through each of them."""
        scale = 1 / (2 * math.pi * h)
        low, high = min(r["h_omega"] for r in rows), max(r["h_omega"] for r in rows)
        # The curve is of an oscillator without damping.
        dense = [] if own_damping(rows) else curve.between(low, high)
        between = [(x * scale, y) for x, y in dense]
        at = [(row["h_omega"] * scale, row["damping_ratio_predicted"]) for row in rows]
        return sorted({*between, *(point for point in at if not math.isnan(point[1]))})

    def chosen_rows(self):
        """The rows of methods that choose their steps, at the tolerance that is drawn."""
        rtols = {row["rtol"] for row in self.chosen}
        rtol = min(rtols, key=lambda value: abs(math.log(value / RTOL)), default=math.nan)
        return [row for row in self.chosen if math.isclose(row["rtol"], rtol)]

    def draw_chosen(self, top):
        """How long the steps are that methods choose beside a fast vibration that is hardly excited."""
        rows = self.chosen_rows()
        rtol = rows[0]["rtol"]
        fast = sorted({row["omega_fast"] for row in rows})
        note = "at ω = " + ", ".join(f"{omega:g}" for omega in fast)
        note += ", from pale to dark; hollow: held at the limit; ×: failed"
        self.heading(TABLE, top, f"Steps chosen by the method at rtol {number(rtol)}", note)
        of_fastest = {row["method"]: row for row in rows if row["omega_fast"] == fast[-1]}
        methods = list(dict.fromkeys(row["method"] for row in rows))
        reach = {m: of_fastest[m]["h_omega_mean"] if m in of_fastest else 0 for m in methods}
        methods.sort(key=lambda m: reach[m] if reach[m] > 0 else 0)
        left, right = TABLE + NAMES, TABLE_END - REJECTED
        axes = self.sheet.axes(left, top, right - left, DOT_ROW * len(methods))
        axes.set_xscale("log")
        axes.set_ylim(-0.6, len(methods) + 0.2)
        for j, method in enumerate(methods):
            axes.axhline(j, color=GRID, linewidth=0.8, zorder=1)
            for row in rows:
                if row["method"] == method and row["h_omega_mean"] > 0:
                    draw_dot(axes, row, j, FREQUENCY_COLORS[min(3, fast.index(row["omega_fast"]))])
            most = max(row["rejected_share"] for row in rows if row["method"] == method)
            style = {"transform": axes.get_yaxis_transform(), "size": SIZE, "va": "center"}
            axes.text(1.02, j, f"{100 * most:.2g} %", color=FAINT, **style)
        axes.text(1.02, len(methods) - 0.1, "rejected", color=FAINT, **style)
        axes.set_yticks(range(len(methods)), methods, size=SIZE)
        axes.tick_params(axis="y", length=0)
        axes.tick_params(axis="x", length=3, color=FAINT, labelsize=9)
        log_ticks(axes.xaxis)
        axes.grid(True, axis="x")
        axes.spines["left"].set_visible(False)
        words = "mean h ω of a fast vibration, hardly excited, beside a slow one"
        axes.set_xlabel(words, fontsize=10, labelpad=2)


def draw_dot(axes, row, height, color):
    """The mean step of one method at one frequency."""
    if row["outcome"] != "reached_end":
        axes.plot([row["h_omega_mean"]], [height], "x", color=color, markersize=5, mew=1.4)
        return
    is_held = row["stability_limited_steps"] > 0.5 * row["steps"]
    face = "white" if is_held else color
    style = {"markerfacecolor": face, "markeredgecolor": color, "mew": 1.5}
    axes.plot([row["h_omega_mean"]], [height], "o", markersize=5, zorder=3, **style)


def difference(curve):
    """The largest difference of limits measured and predicted, relative, in words."""
    finite = [(p, m) for p, m in curve.limits if 0 < p < math.inf]
    if not finite:
        agree = all(p == m for p, m in curve.limits if not math.isnan(p))
        return "as theory" if agree else "differs"
    if not all(math.isfinite(m) for _, m in finite):
        return "differs"
    largest = max((abs(m - p) / p for p, m in finite), default=0)
    return f"{number(largest)} off"
