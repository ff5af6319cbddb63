"""Whether motions are told in few bytes as the page's format says, and which frames and runs are
kept where room is scarce."""

import base64
import unittest
import zlib
from types import SimpleNamespace

import numpy as np

import budget
import encoding


class Encoding(unittest.TestCase):
    """The format's ends, which the pages of whole folders do not show."""

    def test_what_is_outside_is_moved_into_the_box_and_said(self):
        steps, left_box = encoding.quantised([[[0, 0, 0], [2, 2, 2]]], np.zeros(3), 2.0)
        self.assertEqual((steps.tolist(), left_box), ([[[0] * 3, [65535] * 3]], False))
        for outside in (2.1, -0.1, np.inf, -np.inf, np.nan, 1e300):
            steps, left_box = encoding.quantised([[[1, 1, outside]]], np.zeros(3), 2.0)
            self.assertTrue(left_box)
            self.assertIn(steps[0, 0, 2], (0, 65535))

    def test_distances_are_bytes(self):
        # 1 + 254 * 7 / 14 at the middle of the logarithms.
        distances = [0.0, 1e-14, 1.1e-14, 1e-7, 1.0, 7.0, np.inf, np.nan, 1e30]
        blob = encoding.distances_blob(np.array([distances]))
        codes = zlib.decompress(base64.b64decode(blob), -15)
        self.assertEqual(list(codes), [0, 0, 2, 128, 255, 255, 255, 255, 255])


def of_size(bytes_a_frame, bytes_a_run=0):
    """An encode function whose runs take so many bytes a frame, and so many beside."""
    return lambda run, frames: SimpleNamespace(
        run=run, frames=frames, size=bytes_a_run + bytes_a_frame * len(frames)
    )


class Budget(unittest.TestCase):
    """Which runs and frames there is room for."""

    def test_the_first_and_the_last_frame_stay(self):
        for count, longest, limit in ((60, 60, 7), (1, 60, 7), (2, 60, 2), (33, 60, 20), (1, 1, 9)):
            frames = budget.kept_frames(count, longest, limit)
            self.assertEqual((frames[0], frames[-1]), (0, count - 1))
            self.assertEqual(frames, sorted(set(frames)))
        self.assertEqual(budget.kept_frames(5, 5, 9), [0, 1, 2, 3, 4])
        # Runs keep frames at the same places.
        whole, short = budget.kept_frames(60, 60, 11), budget.kept_frames(31, 60, 11)
        self.assertEqual(short[:-1], [place for place in whole if place < 30])

    def test_each_choice_has_less_than_the_one_before(self):
        choices = budget.ladder(21, 60)
        self.assertEqual((choices[0], choices[-1]), ((21, 60), (1, 2)))
        for (runs, frames), (fewer, less) in zip(choices, choices[1:]):
            self.assertTrue(fewer <= runs and less <= frames and (fewer, less) != (runs, frames))
        self.assertEqual(budget.ladder(1, 1), [(1, 1)])
        choices = budget.ladder(60, 101)
        self.assertIn((20, 60), choices)
        self.assertTrue(all(frames >= 60 for runs, frames in choices if runs > 20))

    def test_frames_go_first_then_the_least_telling_runs(self):
        runs = budget.fit([60] * 5, 5 * 60 * 100, of_size(100))
        self.assertEqual([run.frames for run in runs], [tuple(range(60))] * 5)
        self.assertEqual(len(budget.fit([60] * 9, 9 * 40 * 100, of_size(100))), 9)
        both = budget.fit([60] * 20, 150 * 100, of_size(100))
        self.assertEqual([run.run for run in both], list(range(len(both))))
        self.assertTrue(1 < len(both) < 20)
        self.assertEqual(both[0].frames[-1], 59)
        # The energies of runs lie beside their frames and cost no frames.
        runs = budget.fit([101] * 30, 30 * (20_000 + 101 * 100), of_size(100, 20_000))
        self.assertEqual([len(run.frames) for run in runs], [101] * 30)
        self.assertIsNone(budget.fit([60] * 20, 199, of_size(100)))

    def test_what_is_chosen_fits_and_is_not_far_below(self):
        for room in (300, 1000, 5000, 20000, 100000):
            runs = budget.fit([60] * 20, room, of_size(100))
            size = sum(run.size for run in runs)
            # Choices differ by a fifth, or by one run of at least two.
            self.assertTrue(0.5 * room <= size <= room, f"{size} of {room}")
