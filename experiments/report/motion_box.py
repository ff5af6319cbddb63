"""The cube that the positions of a page's motions are told in, and the nodes that never move."""

import math

import numpy as np

from measurements import BadInput

# How far runs may go out of the reference's box on each side, as a part of its side.
MARGIN = 0.25
# How far a motion that may have diverged is believed, as a multiple of the first frame's extent.
BELIEVED = 10


def bounds(motion, reach=math.inf):
    """The least and the largest coordinates (3,) that are numbers. Frames count in which every node
    is within `reach` [m] of the first frame's middle in each coordinate."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    middle = None
    for frame in range(len(motion.times)):
        (positions,) = motion.positions([frame])
        if middle is None:
            middle = (positions.min(axis=0) + positions.max(axis=0)) / 2
        if reach < math.inf and not (np.abs(positions - middle) <= reach).all():
            continue
        finite = np.isfinite(positions)
        low = np.minimum(low, np.where(finite, positions, np.inf).min(axis=0))
        high = np.maximum(high, np.where(finite, positions, -np.inf).max(axis=0))
    return low.astype(float), high.astype(float)


def reach_of(motion):
    """How far [m] from its first frame a motion is believed that no reference vouches for; all the
    way where that frame has no extent to compare with."""
    (first,) = motion.positions([0])
    extent = float(np.ptp(first, axis=0).max())
    return BELIEVED * extent if 0 < extent < math.inf else math.inf


def box_of(motions, first_is_reference):
    """The lower corner [m] and the side [m] of the first motion's cube, widened for the others by
    no more than MARGIN to each side. A first motion that is no reference's may have diverged:
    frames far off its start do not count."""
    low, high = bounds(motions[0], math.inf if first_is_reference else reach_of(motions[0]))
    if not np.isfinite(low + high).all():
        raise BadInput("the first motion has no positions")
    side = float((high - low).max()) or 1.0
    least, most = low - MARGIN * side, high + MARGIN * side
    for motion in motions[1:]:
        own_low, own_high = bounds(motion)
        low = np.minimum(low, np.clip(own_low, least, low))
        high = np.maximum(high, np.clip(own_high, high, most))
    return low, float((high - low).max()) or 1.0


def against(gravity):
    """The unit vector (3,) against gravity, as a list; None where there is no gravity, or it is not
    known."""
    if not isinstance(gravity, list) or not 0 < len(gravity) <= 3:
        return None
    if not all(isinstance(one, (int, float)) and math.isfinite(one) for one in gravity):
        return None
    size = math.hypot(*gravity)
    return [-one / size + 0.0 for one in [*gravity, 0, 0][:3]] if 0 < size < math.inf else None


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
