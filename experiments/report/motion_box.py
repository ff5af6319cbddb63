"""The cube that the positions of a page's motions are told in, and the nodes that never move."""

from dataclasses import dataclass

import numpy as np

from measurements import BadInput

# How far runs may go out of the reference's box on each side, as a part of its side.
MARGIN = 0.25


@dataclass(frozen=True)
class Box:
    """The cube that positions are told in: its lower corner [m] and its side [m]."""

    low: np.ndarray
    size: float


def bounds(motion):
    """The least and the largest coordinates (3,) that are numbers, over all frames."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for frame in range(len(motion.times)):
        (positions,) = motion.positions([frame])
        finite = np.isfinite(positions)
        low = np.minimum(low, np.where(finite, positions, np.inf).min(axis=0))
        high = np.maximum(high, np.where(finite, positions, -np.inf).max(axis=0))
    return low.astype(float), high.astype(float)


def box_of(motions):
    """The box of the first motion, widened for the others by no more than MARGIN to each side."""
    low, high = bounds(motions[0])
    if not np.isfinite(low + high).all():
        raise BadInput("the first motion has no positions")
    side = float((high - low).max()) or 1.0
    least, most = low - MARGIN * side, high + MARGIN * side
    for motion in motions[1:]:
        own_low, own_high = bounds(motion)
        low = np.minimum(low, np.clip(own_low, least, low))
        high = np.maximum(high, np.clip(own_high, high, most))
    return Box(low, float((high - low).max()) or 1.0)


def unmoved(motion):
    """The nodes that are at one place in all frames; none where there is one frame only."""
    if len(motion.times) < 2:
        return []
    (first,) = motion.positions([0])
    still = np.ones(motion.nodes, bool)
    for frame in range(1, len(motion.times)):
        (positions,) = motion.positions([frame])
        still &= (positions == first).all(axis=1)
    return np.flatnonzero(still).tolist()
