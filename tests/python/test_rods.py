"""Rods in Python: scenes, methods, tensions; what answers to an accuracy leave out."""

import unittest

import numpy as np

import qddot


def pendulum(**changes):
    """A mass of 2 kg on a rod of 0.7 m, let go from the horizontal."""
    given = dict(
        positions=[[0.0, 0.0], [0.7, 0.0]],
        springs=[[0, 1]],
        stiffness=0.0,
        rigid=True,
        mass=2.0,
        pinned=[0],
        gravity=[0.0, -9.81],
        until=1.0,
    )
    return qddot.Scene(**{**given, **changes})


class Rods(unittest.TestCase):
    """Motions with rods."""

    def test_a_pendulum_keeps_its_length_and_has_a_tension(self):
        times = np.linspace(0, 1, 11)
        solution = qddot.solve(pendulum(), "rattle8", step_size=0.01, save_at=times).or_raise()
        x = solution.q[:, 1]
        self.assertLess(np.abs(np.linalg.norm(x, axis=1) - 0.7).max(), 1e-15)
        # m g cos(theta) + m |v|^2/L, with |v|^2 = 2 g L cos(theta) from the horizontal.
        expected = 3 * 2 * 9.81 * -x[:, 1] / 0.7
        self.assertEqual(solution.tensions.shape, (11, 1))
        # The energy is right to 1e-11 of itself.
        self.assertLess(np.abs(solution.tensions[:, 0] - expected).max(), 1e-9)
        end = qddot.solve(pendulum(), "rattle8", step_size=0.01)
        np.testing.assert_array_equal(end.tensions[0], solution.tensions[-1])

    def test_methods_without_rods_are_refused_by_name(self):
        with self.assertRaisesRegex(ValueError, "take rattle"):
            qddot.solve(pendulum(), "verlet", step_size=0.01)
        with self.assertRaisesRegex(ValueError, "no rods"):
            qddot.solve(qddot.Scene.load("pendulum"), "rattle", step_size=0.001)

    def test_an_answer_has_an_error_bar(self):
        answer = qddot.solve(pendulum(), accuracy=1e-8).or_raise()
        exact = qddot.solve(pendulum(), "rattle8", step_size=0.0005)
        moved = np.linalg.norm(exact.end.q[1] - [0.7, 0])
        error = np.linalg.norm(answer.end.q[1] - exact.end.q[1]) / moved
        self.assertLessEqual(error, answer.error_estimate)
        self.assertEqual(answer.left_out, "")


class Scenes(unittest.TestCase):
    """Scenes with rods."""

    def test_rods_are_springs_that_are_rigid(self):
        scene = pendulum()
        self.assertEqual(scene.rigid.tolist(), [True])
        again = qddot.Scene.from_toml(scene.to_toml())
        self.assertEqual(again.rigid.tolist(), [True])
        self.assertEqual(again.rest_length.tolist(), [0.7])
        self.assertEqual(scene.replace(rigid=False, stiffness=50.0).rigid.tolist(), [False])

    def test_springs_above_a_stiffness_are_rods(self):
        above = pendulum(rigid=None, stiffness=1e7, rods_above=1e6)
        self.assertEqual(above.rigid.tolist(), [True])

    def test_a_wrong_length_is_refused(self):
        with self.assertRaisesRegex(qddot.InvalidInput, "between nodes 0 and 1 is 0.6"):
            pendulum(rest_length=0.6)


class InPlaceOfSprings(unittest.TestCase):
    """Rods that stand for stiff springs as far as an accuracy lets them."""

    def test_the_error_bar_holds_and_the_answer_says_so(self):
        scene = qddot.Scene.from_toml(
            'until = 0.1\n[generator]\nkind = "hemmed_cloth"\nnodes = 8\n'
        )
        answer = qddot.solve(scene, accuracy=1e-2, save_at=[0.05, 0.1]).or_raise()
        self.assertTrue(answer.left_out.startswith("left out: 21 stiff springs are rods here"))
        self.assertTrue(np.isfinite(answer.tensions).any())
        self.assertEqual(len(answer.tensions), 2)
        springs = qddot.solve(scene, accuracy=1e-5, keep=["rods"]).or_raise()
        self.assertEqual(springs.left_out, "")
        self.assertIsNone(springs.tensions)
        moved = np.linalg.norm(springs.end.q - scene.positions, axis=1).max()
        error = np.linalg.norm(answer.end.q - springs.end.q, axis=1).max() / moved
        self.assertLessEqual(error, answer.error_estimate)
        self.assertLessEqual(answer.error_estimate, 1e-2)
        # So small an accuracy shows how the hem stretches.
        self.assertEqual(qddot.solve(scene, accuracy=1e-7).or_raise().left_out, "")


class InPlaceOfSmallForces(unittest.TestCase):
    """Natural modes in place of small motions."""

    def test_a_small_pluck_is_linear(self):
        scene = qddot.Scene.from_toml(
            'until = 2\n[generator]\nkind = "plucked_string"\nnodes = 12\nlength = 1\n'
            "stiffness = 1e5\nheight = 1e-7\n"
        )
        answer = qddot.solve(scene, accuracy=1e-4, save_at=[1.0, 2.0]).or_raise()
        self.assertTrue(answer.left_out.startswith("left out: the motion is linear here"))
        self.assertEqual((answer.method, answer.error_estimate_kind), ("exact", "neglected"))
        kept = qddot.solve(scene, accuracy=1e-6, save_at=[1.0, 2.0], keep=["linear"]).or_raise()
        self.assertEqual(kept.left_out, "")
        moved = np.linalg.norm(kept.q - scene.positions, axis=2).max()
        error = np.linalg.norm(answer.q - kept.q, axis=2).max() / moved
        # Steps of the other method end at samples, with an accuracy of their own.
        self.assertLessEqual(error, answer.error_estimate + 1e-6)
