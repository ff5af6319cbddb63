"""Draws the curves of several runs into one pair of axes, each with its name beside it.

A run has a `name`, a `look`, its `times` [s], `positions` (frames, nodes, axes) [m], its total `energy`
[J] at these times, and whether it `failed`.
"""

import math

import numpy as np
from matplotlib import ticker

from labels import Ink, move_labels
from style import FAINT, Look, family_look

EXACT_LOOK = Look("#C8C8C8", "", family_look("exact"))
FONT_SIZE = 9.5
# Ratios up to which 2 and 5 have ticks beside powers of ten.
MOST_DECADES = 1e4
LINE_INK = 2.0


def same(a, b):
    """Whether two runs are one motion, as those of the implicit methods where it is linear."""
    return a.positions.shape == b.positions.shape and np.allclose(a.positions, b.positions)


def draw_curves(axes, runs, curves, mark=""):
    """One curve for each run with its name, a mark at each step where wanted."""
    for i, (run, points) in enumerate(zip(runs, curves)):
        style = {"linewidth": 1.6, "zorder": 3, "marker": mark, "markersize": 2.6}
        if run.look is EXACT_LOOK:
            style = {"linewidth": 5, "zorder": 1.5}
        elif any(same(run, other) for other in runs[:i]):
            # So that the curve below is seen as well.
            style |= {"linestyle": (0, (3, 3)), "marker": ""}
        axes.plot(*points.T, color=run.look.color, **style)
    axes.grid(True)
    axes.tick_params(length=3, color=FAINT, labelsize=FONT_SIZE)
    label_curves(axes, runs, curves)


def label_curves(axes, runs, curves):
    """Names every curve at one of its points."""
    box = axes.bbox
    bounds = (box.x0 + 3, box.y0 + 3, box.x1 - 3, box.y1 - 3)
    ink = Ink(bounds)
    pieces = [in_view(axes.transData.transform(points), bounds) for points in curves]
    for piece in pieces:
        for start, end in zip(piece, piece[1:]):
            ink.add_line(start, end, LINE_INK)
    texts = [draw_label(axes, run) for run in runs]
    to_data = axes.transData.inverted().transform
    move_labels(texts, [anchors(piece) for piece in pieces], ink, to_data)


def in_view(pixels, bounds):
    """The points of a curve up to where it first leaves the bounds, that point included."""
    low, high = np.array(bounds[:2]), np.array(bounds[2:])
    pixels[0] = np.clip(pixels[0], low, high)
    outside = np.any((pixels < low - 3) | (pixels > high + 3), axis=1)
    if not outside.any():
        return np.clip(pixels, low, high)
    first = np.argmax(outside)
    start, step = pixels[first - 1], pixels[first] - pixels[first - 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(step > 0, (high - start) / step, (low - start) / step)
    # Several points, so that a label finds its place along the last straight line.
    last = np.linspace(0, np.nanmin(np.abs(shares)), 8)[1:, None] * step
    return np.vstack([pixels[:first], start + last])


def anchors(piece):
    """A dozen points of the later part of a curve, where the methods have parted."""
    chosen = np.unique(np.linspace(len(piece) / 2, len(piece) - 1, 12).astype(int))
    return [tuple(piece[i]) for i in chosen]


def draw_label(axes, run):
    """The name of a run and how it failed, not yet in its place."""
    words = run.name + (f" blew up by t = {run.times[-1]:g} s" if run.failed else "")
    style = {"size": FONT_SIZE, "color": run.look.text_color, "ha": "center", "va": "center"}
    style["bbox"] = {"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 0.8}
    style["arrowprops"] = {"arrowstyle": "-", "color": run.look.color, "lw": 0.8, "shrinkA": 0}
    return axes.annotate(words, (0, 0), (0, 0), textcoords="offset points", zorder=6, **style)


def draw_energy(axes, runs, farthest=math.inf):
    """The energy over time: its ratio to the first where all is positive, else the difference. Axes do
    not reach to runs that fail or whose energy changes by more than `farthest` [J]."""
    first = runs[0].energy[0]
    if all(run.energy.min() > 0 for run in runs):
        energies = [run.energy / first for run in runs]
        axes.set(yscale="log", ylabel="energy / first energy")
        has_few_decades = max(map(np.max, energies)) < MOST_DECADES * min(map(np.min, energies))
        axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5) if has_few_decades else (1,)))
        axes.yaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
        axes.yaxis.set_minor_locator(ticker.NullLocator())
    else:
        energies = [run.energy - first for run in runs]
        axes.set_ylabel("energy − first energy in J")
    # A run that blows up leaves the axes above, where its name needs room.
    is_tame = [not run.failed and np.ptp(run.energy) <= farthest for run in runs]
    room = 0.05 if all(is_tame) else 0.4
    tame = [energy for energy, tame in zip(energies, is_tame) if tame] or energies[:1]
    ends = [(0, min(map(np.min, tame))), (0, max(map(np.max, tame)))]
    low, high = axes.transData.transform(ends)
    reach = np.maximum(high - low, 1.0)  # in pixels; where the energy stays, it is in the middle
    limits = (low - 0.05 * reach, high + room * reach)
    axes.set_ylim(*axes.transData.inverted().transform(limits)[:, 1])
    axes.set(xlim=(0, runs[0].times[-1]), xlabel="t in s")
    draw_curves(axes, runs, [np.stack([r.times, e], 1) for r, e in zip(runs, energies)])
