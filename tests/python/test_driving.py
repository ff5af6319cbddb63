"""Supports that move and loads that change, from Python: by data and by functions."""

import math
import unittest

import numpy as np

import qddot

K, M, A, W = 100.0, 1.0, 0.1, 7.0


def driven(curve=None, **changes):
    """A mass at rest on a spring of zero rest length to a support that moves."""
    given = dict(stiffness=K, mass=M, pinned=[0], rest_length=0.0, until=3.0)
    motion = {0: curve or qddot.Curve(harmonics=[([A], W)])}
    return qddot.Scene([[0.0], [0.0]], [[0, 1]], motion=motion, **{**given, **changes})


def displacement(t, w=math.sqrt(K / M)):
    return A * w**2 * (math.sin(W * t) - W / w * math.sin(w * t)) / (w**2 - W**2)


class Driving(unittest.TestCase):
    def test_the_motion_has_its_closed_form_and_its_balance(self):
        for method, knob in (
            ("exact", dict(step_size=1.0)),
            ("dprkn12", dict(rtol=1e-12)),
            ("arkode_erk8", dict(rtol=1e-12)),
        ):
            motion = qddot.solve(driven(), method, save_at=[0, 1, 3], **knob)
            for t, q in zip(motion.t, motion.q):
                self.assertLess(abs(q[1, 0] - displacement(t)), 1e-9, method)
                self.assertLess(abs(q[0, 0] - A * math.sin(W * t)), 1e-15)
            energy = motion.energy
            self.assertLess(np.ptp(energy.total + energy.dissipated - energy.driven), 1e-9)
            self.assertGreater(np.max(np.abs(energy.driven)), 0.1)

    def test_a_function_moves_a_support_as_its_formula_does(self):
        by_function = driven(
            qddot.Curve(
                function=lambda t: [A * math.sin(W * t)],
                rate=lambda t: [A * W * math.cos(W * t)],
            )
        )
        for method, knob in (("verlet", dict(step_size=1e-3)), ("ida", dict(rtol=1e-6))):
            one = qddot.solve(by_function, method, **knob)
            other = qddot.solve(driven(), method, **knob)
            self.assertLess(np.max(np.abs(one.q - other.q)), 1e-9, method)
        with self.assertRaisesRegex(ValueError, "exact"):
            qddot.solve(by_function, "exact", step_size=1.0).or_raise()

    def test_an_exception_of_a_function_comes_through(self):
        def fails(t):
            if t > 0.5:
                raise ZeroDivisionError("half a second")
            return [0.0]

        scene = driven(qddot.Curve(function=fails, rate=lambda t: [0.0]))
        with self.assertRaisesRegex(ZeroDivisionError, "half a second"):
            qddot.solve(scene, "rk4", step_size=0.01)

    def test_a_table_a_polynomial_loads_and_gravity(self):
        times = np.linspace(0, 3, 400)
        table = qddot.Curve(times=times, values=A * np.sin(W * times))
        motion = qddot.solve(driven(table), "dprkn8", rtol=1e-10)
        self.assertLess(abs(motion.end.q[1, 0] - displacement(3.0)), 1e-6)  # W^4 dt^4 of A
        # A load and gravity that cancel leave the mass where it is.
        scene = driven(
            qddot.Curve(polynomial=[[0.0], [0.0]]),
            load_in_time={1: qddot.Curve(harmonics=[([2.0], 3.0)])},
            gravity_in_time=qddot.Curve(harmonics=[([-2.0], 3.0)]),
        )
        self.assertLess(abs(qddot.solve(scene, "rk8", step_size=0.01).end.q[1, 0]), 1e-12)

    def test_what_is_driven_comes_back(self):
        scene = driven(load_in_time={1: qddot.Curve(harmonics=[([2.0], 3.0, 0.5)])})
        self.assertEqual(list(scene.motion), [0])
        self.assertEqual(scene.load_in_time[1].harmonics[0][2], 0.5)
        for again in (qddot.Scene.from_toml(scene.to_toml()), scene.replace(mass=M)):
            self.assertEqual(again.content_hash(), scene.content_hash())
        other = scene.replace(motion={})
        self.assertNotEqual(other.content_hash(), scene.content_hash())
        self.assertEqual(other.motion, {})

    def test_wrong_curves_are_refused_in_a_sentence(self):
        curve = qddot.Curve(harmonics=[([A], W)])
        for words, wrong in (
            (r"motion\[1\]: allowed are pinned ones", dict(motion={1: curve})),
            (r"motion\[5\]: node 5 is none of the 2", dict(motion={5: curve})),
            (r"load_in_time\[0\]: allowed are nodes", dict(load_in_time={0: curve})),
            (
                r"motion\[0\]: its vectors have \[2\] components; allowed are 1",
                dict(motion={0: qddot.Curve(harmonics=[([A, A], W)])}),
            ),
            (r"gravity_in_time: 3 is no qddot.Curve", dict(gravity_in_time=3)),
        ):
            with self.assertRaisesRegex(ValueError, words):
                qddot.Scene(
                    [[0.0], [1.0]], [[0, 1]], stiffness=K, mass=M, pinned=[0], **wrong
                )
        for words, wrong in (
            ("function and rate", dict(function=lambda t: [t])),
            ("values: 2 for 3 times", dict(times=[0, 1, 2], values=[[0.0], [1.0]])),
            ("times: allowed are times that ascend", dict(times=[0, 0], values=[[0], [1]])),
            ("interpolation: 'cubic'", dict(interpolation="cubic")),
            ("harmonics", dict(harmonics=[(1.0,)])),
        ):
            with self.assertRaisesRegex(ValueError, words):
                qddot.Curve(**wrong)
        with self.assertRaisesRegex(qddot.InvalidInput, "frequency: -1"):
            driven(qddot.Curve(harmonics=[([A], -1.0)]))

    def test_an_accuracy_holds_for_a_driven_motion(self):
        for of in ("positions", "path", "energy"):
            answer = qddot.solve(driven(), accuracy=1e-6, accuracy_of=of, save_at=[1.0, 3.0])
            self.assertTrue(answer.success, answer.message)
            error = max(abs(q[1, 0] - displacement(t)) for t, q in zip(answer.t, answer.q))
            self.assertLess(error, 1e-6 * 0.3 if of != "energy" else 1e-4)


if __name__ == "__main__":
    unittest.main()
