"""A network of springs as it is seen in a picture."""

import numpy as np
from matplotlib.collections import LineCollection

# Lines are thinner the more springs there are. If there are more than MANY, springs are left out
# that are longer by DIAGONAL than the shortest at both of their ends, such as diagonals of grids.
THICK, THIN, MANY = 1.3, 0.35, 4000
DIAGONAL = 1.35
MOST_DOTS = 60


def view(dimension, gravity):
    """The matrix that takes a point to the picture; in space obliquely from above, with gravity
    downwards."""
    if dimension < 3:
        return np.eye(dimension, 2)
    weight = np.linalg.norm(gravity)
    up = -np.array(gravity) / weight if weight > 0 else np.array([0.0, 0.0, 1.0])
    # The first axis that is not along the vertical comes towards the viewer.
    front = np.eye(3)[np.argmin(np.abs(up) > 0.9)]
    front = front - up * (front @ up)
    front /= np.linalg.norm(front)
    across = np.cross(up, front)
    return np.stack([0.83 * across - 0.56 * front, 0.94 * up - 0.19 * across - 0.28 * front], 1)


def without_diagonals(positions, springs):
    """The springs that are drawn where there are too many to be told apart."""
    lengths = np.linalg.norm(np.diff(positions[springs], axis=1)[:, 0], axis=1)
    shortest = np.full(len(positions), np.inf)
    for end in springs.T:
        np.minimum.at(shortest, end, lengths)
    return springs[lengths <= DIAGONAL * shortest[springs].max(axis=1)]


def draw_springs(axes, points, springs, color, order):
    """A network: its springs as lines and, where there are few nodes, these as dots."""
    share = min(1.0, len(springs) / MANY)
    width = THICK + (THIN - THICK) * share**0.5
    lines = LineCollection(points[springs], colors=color, linewidths=width, zorder=order)
    axes.add_collection(lines)
    if len(points) <= MOST_DOTS:
        axes.plot(*points.T, "o", color=color, markersize=3, linewidth=0, zorder=order + 0.5)
