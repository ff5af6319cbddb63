"""What a prompt shows: one short line, or a table."""

import unittest

import qddot


class Shown(unittest.TestCase):
    def test_results_are_shown_in_short(self):
        cloth = qddot.scenes.cloth(nodes=6)
        chain = qddot.scenes.chain(nodes=8)
        for shown, holds in (
            (qddot.method("verlet"), ("verlet", "order 2", "step_size")),
            (qddot.method("exact"), ("exact",)),
            (qddot.modes(cloth, 8), ("Modes 8 of", "w_max =", "...")),
            (qddot.modes(cloth, 3), ("Modes 3 of", "rad/s")),
            (qddot.equilibrium(cloth), ("36 nodes", "reached", " J")),
        ):
            with self.subTest(holds=holds):
                self.assertEqual(len(repr(shown).splitlines()), 1)
                self.assertLess(len(repr(shown)), 250)
                for part in holds:
                    self.assertIn(part, repr(shown))
        orders = qddot.convergence(chain, "verlet", 1e-3, 2, until=0.05)
        self.assertEqual(len(repr(orders).splitlines()), 4)
        self.assertIn("verlet", repr(orders))

    def test_advices_are_a_sequence(self):
        advices = qddot.advise(qddot.scenes.pendulum(), [1e-2, 1e-4], until=0.5)
        self.assertEqual(len(advices), 2)
        self.assertEqual([a.accuracy for a in advices], [1e-2, 1e-4])
        self.assertIs(advices[-1], advices.for_each[-1])

    def test_help_begins_with_what_is_called(self):
        for name in ("solve", "advise", "work_precision", "reference", "modes", "equilibrium"):
            self.assertIn(name, qddot.__doc__)
            self.assertTrue(callable(getattr(qddot, name)))


if __name__ == "__main__":
    unittest.main()
