"""Draws the lowest natural modes that the program modes found.

Call: modes.py DIR, the folder with modes.csv, shapes.csv, springs.csv; writes DIR/modes.png and
DIR/modes.svg. Up to six modes are drawn: first the growing ones, then the vibrating ones from the
lowest on. Modes of frequency zero are drawn if there are no others.
"""

import sys
from dataclasses import dataclass

import numpy as np

from measurements import read_facts, read_table
from names import shown
from network import MANY, draw_springs, view, without_diagonals
from sheet import Sheet, main
from style import COOL, WARM, number

MOST_PANELS = 6
COLUMNS = 3
PANEL, GAP, TITLE = 3.1, 0.15, 0.3
TOP, SIDE = 0.85, 0.15
# The largest displacement as a part of the scene's size, as it is seen.
AMPLITUDE = 0.16
REST = "#BDBDBD"
# The least and the greatest height of a panel as a part of its width.
FLATTEST, TALLEST = 0.4, 1.15


@dataclass(frozen=True)
class Mode:
    """A mode: its rank, omega in rad/s (minus the rate where it grows), displacements by node."""

    rank: int
    omega: float
    displacements: np.ndarray

    @property
    def label(self):
        """Rank and frequency."""
        if self.omega < 0:
            return f"mode {self.rank}: grows at {number(-self.omega)} /s"
        if self.omega == 0:
            return f"mode {self.rank}: 0 Hz"
        return f"mode {self.rank}: {number(self.omega / (2 * np.pi))} Hz"

    @property
    def color(self):
        """Warm where it grows, else cool."""
        return WARM[0] if self.omega < 0 else COOL[0]


def read_modes(folder):
    """Positions by node and axis, and the modes whose shapes are there."""
    rows = read_table(folder / "modes.csv")
    omegas = {int(row["mode"]): float(row["omega"]) for row in rows}
    table = np.loadtxt(folder / "shapes.csv", delimiter=",", skiprows=1, ndmin=2)
    if table.size == 0:
        sys.exit(f"modes.py: {folder} has no mode to draw: nothing in the scene can move")
    ranks = table[:, 0].astype(int)
    positions, displacements = np.split(table[:, 2:], 2, axis=1)
    modes = [Mode(r, omegas[r], displacements[ranks == r]) for r in np.unique(ranks)]
    return positions[ranks == ranks[0]], modes


def chosen(modes):
    """The modes to be drawn, by rank."""
    ordered = sorted(modes, key=lambda mode: (mode.omega == 0, mode.rank))
    return sorted(ordered[:MOST_PANELS], key=lambda mode: mode.rank)


def drawn_points(positions, modes, look):
    """The nodes at rest and in each mode, in the picture's plane."""
    rest = positions @ look
    extent = max(np.ptp(rest, axis=0).max(), 1e-12)
    shapes = []
    for mode in modes:
        moved = mode.displacements @ look
        if positions.shape[1] == 1:  # along a line nothing would be seen: drawn across it
            moved = moved[:, ::-1]
        largest = np.linalg.norm(moved, axis=1).max()
        shapes.append(rest + moved * (AMPLITUDE * extent / max(largest, 1e-300)))
    return rest, shapes


def frame(points):
    """The limits in x and y of a panel around the points, and its height in inches."""
    low, high = points.min(axis=0), points.max(axis=0)
    width, height = np.maximum(high - low, 1e-12)
    ratio = np.clip(height / width, FLATTEST, TALLEST)
    half = 0.53 * max(width, height / ratio) * np.array([1, ratio])
    middle = (low + high) / 2
    return middle - half, middle + half, PANEL * ratio


def draw(folder):
    """Draws the picture."""
    origin = read_facts(folder / "modes.json")
    positions, modes = read_modes(folder)
    modes = chosen(modes)
    springs = np.loadtxt(folder / "springs.csv", delimiter=",", skiprows=1, dtype=int, ndmin=2)
    springs = springs.reshape(-1, 2)
    if len(springs) > MANY:
        springs = without_diagonals(positions, springs)
    look = view(positions.shape[1], origin["gravity"])
    rest, shapes = drawn_points(positions, modes, look)
    low, high, tall = frame(np.concatenate([rest, *shapes]))
    rows = -(-len(modes) // COLUMNS)
    height = TOP + rows * (tall + TITLE + GAP)
    sheet = Sheet(2 * SIDE + COLUMNS * PANEL + (COLUMNS - 1) * GAP, height)
    place = {"drawn": "as drawn", "equilibrium": "at equilibrium"}[origin["at"]]
    title = f"{shown(origin['scene']['name'])}: natural modes {place}"
    words = [f"modes of finite frequency: {origin['finite_modes']}"]
    if origin["unstable_directions"] > 0:
        words.append(f"unstable: {origin['unstable_directions']}")
    if origin["omega_max"] is not None:
        words.append(f"highest {number(origin['omega_max'] / (2 * np.pi))} Hz")
    words.append("grey: at rest" if origin["at"] == "equilibrium" else "grey: as drawn")
    if positions.shape[1] == 1:
        words.append("displacements drawn across the line")
    sheet.head(0.15, (0.25, 14, title), (0.54, 10, ", ".join(words)))
    sheet.rule(0.75)
    for i, (mode, shape) in enumerate(zip(modes, shapes)):
        left = SIDE + (i % COLUMNS) * (PANEL + GAP)
        top = TOP + (i // COLUMNS) * (tall + TITLE + GAP)
        middle = {"ha": "center", "va": "center"}
        sheet.text(left + PANEL / 2, top + TITLE / 2, mode.label, size=10.5, **middle)
        axes = sheet.axes(left, top + TITLE, PANEL, tall)
        axes.set_axis_off()
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        draw_springs(axes, rest, springs, REST, 1)
        draw_springs(axes, shape, springs, mode.color, 2)
    sheet.save_as(folder, "modes")


if __name__ == "__main__":
    main(draw)
