"""Cables and springs that break, from Python."""

import math
import unittest

import numpy as np

import qddot

GRAVITY = 9.81


def bouncing():
    """A mass 0.4 m below its pin on a cable of 1 m."""
    return qddot.Scene(
        [[0.0], [0.4]],
        [[0, 1]],
        stiffness=300,
        mass=2,
        pinned=[0],
        gravity=[GRAVITY],
        rest_length=1.0,
        pulls_only=True,
    )


def hanging():
    """Two masses on two springs below each other, at rest lengths; the lower one may break."""
    return qddot.Scene(
        [[0.0], [1.0], [2.0]],
        [[0, 1], [1, 2]],
        stiffness=900,
        mass=1,
        pinned=[0],
        gravity=[GRAVITY],
        breaks_at=[math.inf, 0.018],
    )


class Switching(unittest.TestCase):
    def test_a_cable_does_nothing_while_it_is_slack(self):
        falling = qddot.solve(bouncing(), "verlet", step_size=1e-3, until=0.3)
        self.assertAlmostEqual(falling.end.q[1, 0], 0.4 + GRAVITY / 2 * 0.09, delta=1e-12)
        taut = qddot.solve(bouncing(), "dprkn8", rtol=1e-10, until=0.45)
        # Below l0 = 1 m, by energy: m g (l - 0.4) - k (l - 1)^2/2 = m v^2/2.
        length, rate = taut.end.q[1, 0], taut.end.v[1, 0]
        self.assertGreater(length, 1)
        squared = 2 * GRAVITY * (length - 0.4) - 150 * (length - 1) ** 2
        self.assertAlmostEqual(squared, rate**2, delta=1e-7)

    def test_breaks_are_listed_with_their_energy(self):
        run = qddot.solve(hanging(), "kahan_li8", step_size=1e-3, until=0.3, save_at=[0.05, 0.3])
        (broken,) = run.breaks
        self.assertEqual(broken.spring, 1)
        self.assertAlmostEqual(broken.strain, 0.018, delta=1e-13)
        self.assertAlmostEqual(broken.energy, 450 * 0.018**2, delta=1e-12)
        self.assertIsNone(broken.t_error)
        self.assertEqual(run.energy.released.tolist(), [0, broken.energy])
        kept = run.energy.total + run.energy.released
        self.assertAlmostEqual(kept[0], kept[1], delta=1e-9)

    def test_an_accuracy_bounds_the_moment(self):
        exact = qddot.solve(hanging(), "dprkn12", rtol=1e-14, until=0.3)
        for accuracy in (1e-3, 1e-6):
            (broken,) = qddot.solve(hanging(), accuracy=accuracy, until=0.3).or_raise().breaks
            self.assertLessEqual(abs(broken.t - exact.breaks[0].t), broken.t_error)
            # The bar is of use: a moment is known about as well as places are.
            self.assertLess(broken.t_error, 100 * accuracy)

    def test_arrays_come_back_and_go_round_a_file(self):
        scene = hanging().replace(cubic=[0.0, -4.0], pulls_only=[True, False])
        for one in (scene, qddot.Scene.from_toml(scene.to_toml())):
            self.assertEqual(one.pulls_only.tolist(), [True, False])
            self.assertEqual(one.cubic.tolist(), [0, -4])
            self.assertEqual(one.breaks_at.tolist(), [math.inf, 0.018])
            self.assertEqual(one.content_hash(), scene.content_hash())

    def test_wrong_values_are_named(self):
        for name, value in (
            ("pulls_only", 1),
            ("breaks_at", [math.inf, -1.0]),
            ("cubic", [0.0, np.nan]),
            ("breaks_at", [0.1, 0.2, 0.3]),
        ):
            with self.assertRaisesRegex(ValueError, name):
                hanging().replace(**{name: value})


if __name__ == "__main__":
    unittest.main()
