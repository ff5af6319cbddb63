"""Dashpots and air from arrays and meshes, and a System's own damping."""

import math
import unittest

import numpy as np

import qddot


def pair(**changes):
    """A mass on a spring with a dashpot: zeta = 0.25, w = 2 rad/s."""
    given = dict(stiffness=4.0, mass=1.0, pinned=[0], rest_length=0.0, damping=1.0, until=3.0)
    return qddot.Scene([[0.0], [1.0]], [[0, 1]], **{**given, **changes})


class Damping(unittest.TestCase):
    def test_arrays_reach_the_scene_and_come_back(self):
        scene = pair(air_damping=0.5)
        self.assertEqual(scene.damping.tolist(), [1.0])
        self.assertEqual(scene.air_damping, 0.5)
        again = qddot.Scene.from_toml(scene.to_toml())
        self.assertEqual(again.content_hash(), scene.content_hash())
        self.assertEqual(scene.replace(damping=2.0).damping.tolist(), [2.0])
        self.assertEqual(pair(damping=None).damping.tolist(), [0.0])

    def test_negative_damping_is_refused_by_name(self):
        with self.assertRaisesRegex(qddot.InvalidInput, r"springs\[0\].damping: -1"):
            pair(damping=-1.0)
        with self.assertRaisesRegex(qddot.InvalidInput, "air_damping: -1"):
            pair(air_damping=-1.0)

    def test_the_motion_has_its_closed_form_and_its_balance(self):
        w, zeta, t = 2.0, 0.25, 3.0
        fast = w * math.sqrt(1 - zeta**2)
        x = math.exp(-zeta * w * t) * (
            math.cos(fast * t) + zeta * w / fast * math.sin(fast * t)
        )
        for method, knob in (("exact", dict(step_size=0.1)), ("arkode_erk8", dict(rtol=1e-12))):
            motion = qddot.solve(pair(), method, save_at=[0, 1, 3], **knob)
            self.assertLess(abs(motion.q[-1, 1, 0] - x), 1e-9)
            energy = motion.energy
            balance = energy.total + energy.dissipated
            self.assertLess(np.ptp(balance), 1e-9)
            self.assertGreater(energy.dissipated[-1], 1.0)
            self.assertLess(motion.energy_loss, 1e-9)

    def test_a_method_that_takes_no_dashpots_says_why(self):
        with self.assertRaisesRegex(ValueError, "kahan_li8: it refuses this damping, since"):
            qddot.solve(pair(), "kahan_li8", step_size=0.01)
        self.assertTrue(qddot.solve(pair(damping=None, air_damping=1), "kahan_li8", step_size=0.01))

    def test_generators_take_damping(self):
        scene = qddot.scenes.chain(nodes=4, stiffness=50, damping_time=0.01, air_damping=2)
        self.assertEqual(scene.damping.tolist(), [0.5] * 3)
        self.assertEqual(scene.air_damping, 2)

    def test_a_systems_own_damping_moves_as_the_scene_does(self):
        def force(q, f):
            np.copyto(f, -4 * q)

        for given in (np.array([[1.0]]), lambda q: np.array([[1.0]])):
            system = qddot.System(
                [1.0],
                force,
                lambda q: 2 * float(q @ q),
                lambda q: np.array([[-4.0]]),
                damping=given,
            )
            for method in ("rk4", "verlet", "implicit_midpoint", "arkode_dirk4", "cvode_bdf_klu"):
                knob = dict(step_size=1e-3) if "_" not in method[:7] else dict(rtol=1e-8)
                if method == "implicit_midpoint":
                    knob = dict(step_size=1e-3)
                own = qddot.solve(system, method, until=3.0, q0=[1.0], **knob)
                drawn = qddot.solve(pair(), method, **knob)
                self.assertLess(abs(own.q[-1, 0] - drawn.q[-1, 1, 0]), 1e-9, method)
                self.assertLess(
                    abs(own.energy.dissipated[-1] - drawn.energy.dissipated[-1]), 1e-9, method
                )

    def test_modes_have_their_damping_ratios(self):
        for damping, air in ((0.02, 0.0), (0.0, 0.3), (0.02, 0.3)):
            scene = pair(damping=damping, air_damping=air)
            found = qddot.modes(scene, 2)
            vibrates = found.squares > 1e-6 * found.omega_max**2
            self.assertTrue(vibrates.any())
            self.assertTrue(np.isnan(found.zeta[~vibrates]).all())
            w = found.omega[vibrates]
            expected = air / (2 * w) + damping / scene.stiffness[0] * w / 2
            self.assertTrue(np.allclose(found.zeta[vibrates], expected, rtol=1e-9))

    def test_damping_that_cannot_be_is_refused(self):
        def made(damping, **given):
            system = qddot.System(
                np.ones(2),
                lambda q, f: np.copyto(f, -q),
                lambda q: float(q @ q) / 2,
                damping=damping,
                **given,
            )
            return qddot.solve(system, "rk4", until=0.1, step_size=0.01, q0=[1.0, 2.0])

        whole = dict(pattern="dense")
        self.assertTrue(made(lambda q: np.eye(2), **whole).success)
        for damping, words in (
            (lambda q: -np.eye(2), "adds energy"),
            (lambda q: np.array([[1.0, 3.0], [3.0, 1.0]]), "adds energy"),
            (lambda q: np.array([[1.0, 0.5], [0.0, 1.0]]), "not symmetric"),
            (np.array([[1.0, 0.5], [0.0, 1.0]]), "not symmetric"),
            (np.eye(3), "its shape is"),
        ):
            with self.assertRaisesRegex(ValueError, words):
                made(damping, **whole)
        with self.assertRaisesRegex(ValueError, "pattern of K"):
            made(np.eye(2))


if __name__ == "__main__":
    unittest.main()
