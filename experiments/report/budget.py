"""Which runs and frames of a motion a page has room for."""

import bisect
import functools

import numpy as np

# While what is shown is too large, frames are dropped down to the first number and then runs down
# to the second, then both to the next pair.
LEAST_FRAMES_AND_RUNS = ((60, 20), (30, 8), (16, 4), (8, 2), (2, 1))


def kept_frames(count, longest, limit):
    """The numbers of the frames that are kept of a run's `count`: its first and last, and others at
    the same places in every run. The longest run has `longest` and keeps `limit`."""
    places = np.rint(np.linspace(0, longest - 1, min(max(limit, 2), longest))).astype(int)
    return sorted({*(int(place) for place in places if place < count), count - 1})


def ladder(runs, frames):
    """Choices (runs, frames) from all to the least, each with less than the one before."""
    choices = [(runs, frames)]
    for least_frames, least_runs in LEAST_FRAMES_AND_RUNS:
        while frames > least_frames:
            frames = max(least_frames, frames * 4 // 5)
            choices.append((runs, frames))
        while runs > least_runs:
            runs -= 1
            choices.append((runs, frames))
    return choices


def fit(counts, room, encode):
    """The first choice of the ladder that fits into `room` bytes, as the list of what
    encode(run, frames) makes of each kept run; None where not even the last does.

    counts: the frames of each run, the most telling first; encode(run, frames) makes what has a
    `size` in bytes of the frames of these numbers.
    """
    longest = max(counts)

    @functools.cache
    def encoded(run, limit):
        return encode(run, tuple(kept_frames(counts[run], longest, limit)))

    def size_of(runs, limit):
        return sum(encoded(run, limit).size for run in range(runs))

    choices = ladder(len(counts), longest)
    first = bisect.bisect_left(choices, True, key=lambda choice: size_of(*choice) <= room)
    if first == len(choices):
        return None
    runs, frames = choices[first]
    return [encoded(run, frames) for run in range(runs)]
