"""Motions as bytes of a page: positions in 16 bits, distances in 8, deflated and in base64."""

import base64
import zlib

import numpy as np

STEPS = 65535  # of a box's side
LEAST_DISTANCE = 1e-14


def blob(data):
    """The bytes as base64 of a raw deflate stream ("deflate-raw"), in ASCII."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    return base64.b64encode(packer.compress(data) + packer.flush()).decode("ascii")


def index_blob(indices):
    """Node numbers as little-endian uint32."""
    return blob(np.ascontiguousarray(indices, dtype="<u4").tobytes())


def quantised(positions, low, size):
    """Positions (frames, nodes, 3) [m] as whole steps of size / 65535 from `low`, uint16. Also
    whether some had to be moved into the box, to whose lower corner goes what is no number."""
    steps = (np.asarray(positions, float) - low) * (STEPS / size)
    outside = ~((steps >= -0.5) & (steps <= STEPS + 0.5))
    steps = np.nan_to_num(steps, nan=0.0, posinf=STEPS, neginf=0.0)
    return np.rint(np.clip(steps, 0, STEPS)).astype("<u2"), bool(outside.any())


def positions_blob(steps):
    """Whole steps (frames, nodes, 3): each frame minus the one before, all low bytes, then all
    high ones."""
    changes = steps.copy()
    changes[1:] -= steps[:-1]  # modulo 65536, as uint16 wraps around
    pairs = changes.reshape(-1).view(np.uint8).reshape(-1, 2)
    return blob(np.ascontiguousarray(pairs.T).tobytes())


def distances_blob(distances):
    """Relative distances (frames, nodes) as one byte each: 0 up to 1e-14, else 1 to 255 by their
    logarithm, where 255 is 1 and more, or no number."""
    known = np.nan_to_num(np.asarray(distances, float), nan=1.0, posinf=1.0)
    decades = np.log10(np.clip(known, LEAST_DISTANCE, 1.0)) + 14
    codes = np.where(known <= LEAST_DISTANCE, 0, 1 + np.rint(254 * decades / 14))
    return blob(codes.astype(np.uint8).tobytes())
