"""Draws the shape in which a scene rests, over the one in which it was drawn.

Call: equilibrium.py DIR, the folder with shape.csv and springs.csv of the program equilibrium; writes
DIR/equilibrium.png and DIR/equilibrium.svg.
"""

import numpy as np

from measurements import read_facts
from names import shown
from network import MANY, draw_springs, view, without_diagonals
from sheet import Sheet, main
from style import COOL, number

WIDTH, TOP, SIDE = 8.0, 0.85, 0.2
# The least and the greatest height of the panel as a part of its width.
FLATTEST, TALLEST = 0.25, 1.1
DRAWN = "#BDBDBD"


def draw(folder):
    """Draws the picture."""
    origin = read_facts(folder / "shape.json")
    table = np.loadtxt(folder / "shape.csv", delimiter=",", skiprows=1, ndmin=2)
    drawn, moved = np.split(table[:, 1:], 2, axis=1)
    springs = np.loadtxt(folder / "springs.csv", delimiter=",", skiprows=1, dtype=int, ndmin=2)
    springs = springs.reshape(-1, 2)
    if len(springs) > MANY:
        springs = without_diagonals(drawn, springs)
    look = view(drawn.shape[1], origin["gravity"])
    before, after = drawn @ look, (drawn + moved) @ look
    points = np.concatenate([before, after])
    low, high = points.min(axis=0), points.max(axis=0)
    width, height = np.maximum(high - low, 1e-12)
    ratio = np.clip(height / width, FLATTEST, TALLEST)
    room = WIDTH - 2 * SIDE
    sheet = Sheet(WIDTH, TOP + ratio * room + SIDE)
    title = f"{shown(origin['scene']['name'])}: at rest"
    if origin["outcome"] != "reached":
        title = f"{shown(origin['scene']['name'])}: where the search ended ({origin['outcome']})"
    farthest = number(np.linalg.norm(moved, axis=1).max())
    words = f"grey: as drawn; a node moved by {farthest} m at most"
    sheet.head(0.15, (0.25, 14, title), (0.54, 10, words))
    axes = sheet.axes(SIDE, TOP, room, ratio * room)
    axes.set_axis_off()
    half = 0.53 * max(width, height / ratio) * np.array([1, ratio])
    middle = (low + high) / 2
    left, right = middle - half, middle + half
    axes.set(xlim=(left[0], right[0]), ylim=(left[1], right[1]), aspect="equal")
    draw_springs(axes, before, springs, DRAWN, 1)
    draw_springs(axes, after, springs, COOL[0], 2)
    sheet.save_as(folder, "equilibrium")


if __name__ == "__main__":
    main(draw)
