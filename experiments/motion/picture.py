"""The picture of a motion by several methods: how it moves, its energy and, of one mass, its phase
plane."""

import math

import numpy as np
from matplotlib import ticker
from matplotlib.collections import LineCollection

from curves import EXACT_LOOK, FONT_SIZE, draw_curves, draw_energy
from motion_box import against
from names import shown
from runs import ACCURACY
from sheet import Sheet
from style import FAINT

AXES = "xyz"
LEFT, TOP, SIDE, GAP = 0.8, 1.0, 3.7, 1.25  # in inches
# A run that blows up would leave the others no room: axes reach little farther than the first run.
FARTHEST = 1.5
# Outlines: how many times, the side of a panel in inches, and how many springs of a large scene.
TIMES, PANEL, MOST_SPRINGS = 4, 2.3, 6000
# The energy of a run may change by so many times the largest kinetic energy before it leaves the axes.
FARTHEST_ENERGY = 3
# The direction from which scenes in space are looked at, where z is upwards.
VIEW = np.array([0.62, -1.0, 0.5])


def limits(values):
    """An axis's limits [m or m/s] around what the first run shows."""
    low, high = float(np.min(values)), float(np.max(values))
    reach = FARTHEST * (high - low) / 2 or 1.0
    return (low + high) / 2 - reach, (low + high) / 2 + reach


def draw_plane(axes, runs, curves, words):
    """Curves of the runs in a plane."""
    axes.set(xlim=limits(curves[0][:, 0]), ylim=limits(curves[0][:, 1]))
    axes.set_xlabel(words[0])
    axes.set_ylabel(words[1], labelpad=1)
    draw_curves(axes, runs, curves)


def farthest_energy(runs):
    """How far [J] energies may change in the picture where some are not above zero."""
    is_positive = all(run.energy.min() > 0 for run in runs)
    return np.inf if is_positive else FARTHEST_ENERGY * max(runs[0].energies["kinetic"]) or np.inf


def moving_axes(drawn, runs):
    """The axes along which the first run moves its only mass, or else the first axis."""
    extents = np.ptp(runs[0].positions[:, drawn.mass, : drawn.dimension], axis=0)
    return [axis for axis in range(drawn.dimension) if extents[axis] > 1e-9 * extents.max()] or [0]


def draw_mass(drawn, runs):
    """The sheet of a scene of one mass: its position over time or its path, the energy, and a phase
    plane for each axis."""
    axes = moving_axes(drawn, runs)
    columns = 3 if len(axes) == 1 else max(2, len(axes))
    rows = 1 if len(axes) == 1 else 2
    sheet = Sheet(LEFT + columns * (SIDE + GAP) - GAP + 0.3, TOP + rows * (SIDE + GAP) - 0.2)

    def panel(number):
        row, column = divmod(number, columns)
        return sheet.axes(LEFT + column * (SIDE + GAP), TOP + row * (SIDE + GAP), SIDE, SIDE)

    def along(axis):
        return [run.positions[:, drawn.mass, axis] for run in runs]

    first = panel(0)
    if len(axes) == 1:
        over_time = [np.stack([run.times, q], 1) for run, q in zip(runs, along(axes[0]))]
        draw_plane(first, runs, over_time, ("t in s", f"{AXES[axes[0]]} in m"))
        first.set_xlim(0, runs[0].times[-1])
    else:
        extents = [float(np.ptp(along(axis)[0])) for axis in axes]
        across, up = sorted(sorted(axes, key=lambda axis: -extents[axes.index(axis)])[:2])
        paths = [np.stack(pair, 1) for pair in zip(along(across), along(up))]
        draw_plane(first, runs, paths, tuple(f"{AXES[axis]} in m" for axis in (across, up)))
    draw_energy(panel(1), runs, farthest_energy(runs))
    for number, axis in enumerate(axes):
        phase = [np.stack([q, run.velocities[:, axis]], 1) for run, q in zip(runs, along(axis))]
        name = AXES[axis]
        words = (f"{name} in m", f"velocity along {name} in m/s")
        draw_plane(panel(columns * (rows - 1) + (2 if rows == 1 else 0) + number), runs, phase, words)
    return sheet


def seen_from(drawn):
    """How a place (..., 3) [m] becomes one of the picture (..., 2) [m], and the words of both axes."""
    up = np.array(against(drawn.gravity) or [0, 0, 1.0])
    if drawn.dimension == 2:
        up = np.array(against(drawn.gravity) or [0, 1.0, 0])
        across = np.cross(up, [0, 0, 1.0])
        return lambda places: np.stack([places @ across, places @ up], -1), plane_words(across, up)
    # The view of a scene with z upwards, turned: the rotation that takes z to `up` along the
    # shortest way.
    axis, cosine = np.cross([0, 0, 1.0], up), up[2]
    turned = -VIEW * [1, 1, -1]
    if cosine > -1:
        turned = VIEW + np.cross(axis, VIEW) + np.cross(axis, np.cross(axis, VIEW)) / (1 + cosine)
    away = turned / np.linalg.norm(turned)
    across = np.cross(up, away)
    across /= np.linalg.norm(across)
    upwards = np.cross(away, across)
    words = ("across in m", "upwards in m")
    return lambda places: np.stack([places @ across, places @ upwards], -1), words


def plane_words(across, up):
    """The words of the axes of a plane scene: its own names where it is not turned."""
    is_upright = np.allclose(up, [0, 1, 0]) and np.allclose(across, [1, 0, 0])
    return ("x in m", "y in m") if is_upright else ("across in m", "upwards in m")


def frame_at(run, time):
    """The last frame that is not after a time [s], or the last of all."""
    return max(0, int(np.searchsorted(run.times, time * (1 + 1e-9), side="right")) - 1)


def torn_at(order, springs, is_whole):
    """The places in a line of nodes, in this order, before which all springs between two neighbours
    are broken."""
    kinds = (springs[which].tolist() for which in (is_whole, ~is_whole))
    whole, broken = (set(map(frozenset, kind)) for kind in kinds)
    pairs = enumerate(zip(order.tolist(), order[1:].tolist()), 1)
    return [place for place, pair in pairs if frozenset(pair) in broken - whole]


def outline(drawn, run, frame, seen):
    """The lines of a picture of one frame: each spring that is not broken, or of a line of nodes
    their displacements."""
    springs, is_whole = run.motion.springs, run.broken_from > frame
    if drawn.dimension == 1:
        start, now = run.positions[0, :, 0], run.positions[frame, :, 0]
        order = np.argsort(start)
        line = np.stack([start, now - start], 1)[order]
        return np.split(line, torn_at(order, springs, is_whole))
    every = -(-len(springs) // MOST_SPRINGS) or 1
    return seen(run.positions[frame])[springs[::every][is_whole[::every]]]


def draw_outlines(drawn, runs):
    """The sheet of a larger scene: a row of outlines for each run, at several times, over those of
    the first run; and the energy."""
    times = np.linspace(0, drawn.until, TIMES + 1)[1:]
    wide = 0.7 + TIMES * (PANEL + 0.25)
    high = len(runs) * (PANEL + 0.62)
    sheet = Sheet(wide + SIDE + 1.2, TOP + 0.1 + max(high, SIDE + 0.7))
    seen, words = seen_from(drawn)
    if drawn.dimension == 1:
        words = ("x at the start in m", "displacement in m")
        frames = [frame_at(runs[0], time) for time in times]
        places = np.concatenate([np.concatenate(outline(drawn, runs[0], f, seen)) for f in frames])
    else:
        places = seen(runs[0].positions).reshape(-1, 2)
    ends = [limits(column) for column in places.T]
    if drawn.dimension > 1:  # as long both ways
        reach = max(high - low for low, high in ends) / 2
        ends = [((low + high) / 2 - reach, (low + high) / 2 + reach) for low, high in ends]
    for row, run in enumerate(runs):
        for column, time in enumerate(times):
            axes = sheet.axes(
                0.7 + column * (PANEL + 0.25), TOP + 0.2 + row * (PANEL + 0.62), PANEL, PANEL
            )
            axes.set(xlim=ends[0], ylim=ends[1])
            axes.tick_params(length=3, color=FAINT, labelsize=7.5)
            axes.grid(True)
            axes.xaxis.set_major_locator(ticker.MaxNLocator(4, prune="both"))
            frame, first = frame_at(run, time), frame_at(runs[0], time)
            lines = {EXACT_LOOK.color: outline(drawn, runs[0], first, seen)} if row else {}
            lines[run.look.color if row else FAINT] = outline(drawn, run, frame, seen)
            thin = min(1.2, 12 / math.sqrt(len(run.motion.springs) or 1))
            for (color, segments), width in zip(lines.items(), (3 * thin, thin) if row else (thin,)):
                axes.add_collection(LineCollection(segments, colors=color, linewidths=width))
            is_over = run.failed and run.times[-1] < time * (1 - 1e-9)
            state = f"blew up by {run.times[-1]:.3g} s" if is_over else f"t = {time:.3g} s"
            color = run.look.text_color if row else FAINT
            axes.set_title(f"{run.name}, {state}", size=8.5, color=color, pad=3)
            if row == len(runs) - 1:
                axes.set_xlabel(words[0], size=FONT_SIZE)
            if column == 0:
                axes.set_ylabel(words[1], size=FONT_SIZE, labelpad=1)
            else:
                axes.tick_params(labelleft=False)
    draw_energy(sheet.axes(wide + 0.85, TOP + 0.2, SIDE, SIDE), runs, farthest_energy(runs))
    return sheet


def draw_motion(drawn, step_size, exact, runs):
    """The sheet of the runs at this step size (text) in s; `exact`: the run called exact, or None."""
    together = [*([exact] if exact else []), *runs]
    draw = draw_outlines if drawn.mass is None else draw_mass
    sheet = draw(drawn, together)
    title = f"{shown(drawn.name)}: h = {step_size} s"
    words = "no run is known to be exact"
    if exact:
        words = f"exact: {exact.method}, with an error of at most {ACCURACY}"
    sheet.head(0.25, (0.3, 14, title), (0.6, 10, words))
    return sheet
