"""The numbers of pages: how they are worded, where they come from and where two kinds cross."""

import math
import unittest
from unittest import mock

import chart_data
import page_data


class Words(unittest.TestCase):
    def test_numbers(self):
        for value, words in ((0.00098, "0.98 ms"), (1.23e-5, "12 µs"), (9.96e-5, "0.10 ms"), (0.1234, "0.12 s"),
                             (99.6, "1 min 40 s"), (120, "2 min"), (3e-8, "30 ns"), (0.0099, "9.9 ms")):  # fmt: skip
            self.assertEqual(words, page_data.seconds(value))
        for value, words in ((1.04, "1.0"), (12.5, "12"), (12345, "12,000"), (9.1e-7, "9.1e-7"), (0, "0"),
                             (-0.25, "−0.25"), (float("inf"), "∞"), (1e-4, "1e-4"), (0.996, "1.0")):  # fmt: skip
            self.assertEqual(words, page_data.figures(value))
        self.assertEqual("1e-3", page_data.accuracy(0.001))
        self.assertEqual("97 %", page_data.percent(0.974))

    def test_what_is_not_there_is_an_error(self):
        for call in (
            lambda: page_data.record("nothing"),
            lambda: page_data.rows("methods", "nothing.csv"),
            lambda: page_data.rows("methods", "methods.csv", nothing=1),
            lambda: page_data.row("methods", "methods.csv", family="sundials"),
            lambda: page_data.sample("README.md", "a line that nobody wrote " * 2),
        ):
            with self.assertRaises(page_data.BadPage):
                call()

    def crossing_of(self, times):
        """The crossing of kinds with these times by ratio, explicit and implicit; None: not reached."""
        cells = [
            {"stiffness_ratio": ratio, "kind": kind, "method": time and "m", "time_s": time or ""}
            for ratio, pair in times.items()
            for kind, time in zip(("explicit", "implicit"), pair)
        ]
        with mock.patch.object(chart_data, "rows", lambda *_, **__: cells):
            return chart_data.crossing("made", 1e-3)

    def test_a_crossing_lies_where_both_take_as_long(self):
        # Explicit time grows as the root of the ratio, implicit time stays: they meet at 900.
        times = {10.0**n: (10 ** (n / 2), 30) for n in range(7)}
        self.assertAlmostEqual(900, self.crossing_of(times), places=6)
        self.assertEqual(1, self.crossing_of({1: (2, 1), 10: (3, 1)}))
        self.assertTrue(math.isnan(self.crossing_of({1: (1, 2), 10: (1, 2)})))
        # Beyond a ratio that explicit methods do not reach, implicit ones are ahead; where neither
        # does, nothing is known.
        self.assertEqual(10, self.crossing_of({1: (1, 2), 10: (None, 2), 100: (None, None)}))
        # An advantage that is lost again is none.
        lost = {1: (2, 1), 10: (2, 1), 100: (1, 2), 1000: (2, 1)}
        self.assertAlmostEqual(math.sqrt(1e5), self.crossing_of(lost), 6)
