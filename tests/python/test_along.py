"""States and errors on the way: a solution at any time, and errors at all times of a run."""

import pickle
import unittest
import warnings

import numpy as np

import problems
import qddot

TIMES = np.linspace(0, 1, 41)


def harmonic(q, f):
    np.copyto(f, -4 * q)


HARMONIC = qddot.System([1.0], harmonic, lambda q: 2 * float(q @ q), [[-4.0]], name="harmonic")


def errors_of_one_step(method, h):
    """The largest errors of q and v after one step, over the phases of q = cos 2t."""
    errors = []
    for t in np.linspace(0, np.pi, 16):
        there = dict(q0=[np.cos(2 * t)], v0=[-2 * np.sin(2 * t)])
        end = qddot.solve(HARMONIC, method, step_size=h, until=h, **there).or_raise()
        q, v = np.cos(2 * (t + h)), -2 * np.sin(2 * (t + h))
        errors.append((abs(end.q[-1, 0] - q), abs(end.v[-1, 0] - v)))
    return np.max(errors, axis=0)


class Anytime(unittest.TestCase):
    def test_samples_have_the_error_of_the_steps(self):
        # q = cos 2t, at times that are in step with nothing. A state between ends of steps of one
        # size is that of one shorter step, whose error comes to those of the steps before. Theirs
        # may be smaller with symplectic methods alone: they cancel over a period. SUNDIALS' methods
        # end other steps at other times, to the same tolerance: their errors are some of it.
        times = np.sort(np.random.default_rng(3).uniform(0, 3, 50))
        for method in qddot.methods():
            if set(method.needs) - {"stiffness", "constant_stiffness", "potential"}:
                continue
            with self.subTest(method.name):
                h = 0.05
                knob = {"step_size": h} if method.knob == "step_size" else {"rtol": 1e-6}
                run = dict(q0=[1.0], until=3.0, **knob)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # explicit_euler's energy grows
                    sol = qddot.solve(HARMONIC, method.name, **run).or_raise()
                    q, v = sol(times)
                    is_symplectic = "symplectic" in method.traits
                    alone = errors_of_one_step(method.name, h) if is_symplectic else (0, 0)
                self.assertEqual((q.shape, v.shape), ((50, 1), (50, 1)))
                ends = np.arange(61) * h
                q_ends, v_ends = sol(ends)
                q_ends, v_ends = q_ends[:, 0], v_ends[:, 0]
                for size, one, between, at_steps in (
                    (1, alone[0], q[:, 0] - np.cos(2 * times), q_ends - np.cos(2 * ends)),
                    (2, alone[1], v[:, 0] + 2 * np.sin(2 * times), v_ends + 2 * np.sin(2 * ends)),
                ):
                    least = size * (1e-13 if method.knob == "step_size" else 1e-5)
                    most = max(1.5 * np.max(np.abs(at_steps)) + one, least)
                    self.assertLess(np.max(np.abs(between)), most)

    def test_an_answer_ends_where_it_was_judged_whatever_is_saved(self):
        # The second is taken by a method that ends steps at these times.
        for scene in (
            qddot.scenes.cloth(nodes=4, damping_time=0.03, until=0.3),
            qddot.scenes.shaken_pendulum(damping_time=1e-3, until=3),
        ):
            times = np.array([0.3, 0.5, 1.0]) * scene.until
            for of in ("positions", "path"):
                plain = qddot.solve(scene, accuracy=1e-6, accuracy_of=of)
                saved = qddot.solve(scene, accuracy=1e-6, accuracy_of=of, save_at=times)
                self.assertTrue(np.array_equal(saved.q[-1], saved.end.q))
                energy = saved.energy
                self.assertEqual(energy.total[-1], energy.kinetic[-1] + energy.potential[-1])
                if (plain.method, plain.value) == (saved.method, saved.value):
                    self.assertTrue(np.array_equal(saved.end.q, plain.end.q), of)

    def test_any_time_is_that_of_save_at(self):
        cloth = qddot.scenes.cloth(nodes=4)
        saved = dict(until=1.0, save_at=TIMES)
        for run in (
            dict(method="blanes_moan4", step_size=3e-3), dict(method="cvode_bdf", rtol=1e-4),
            dict(accuracy=1e-3),
        ):  # fmt: skip
            plain = qddot.solve(cloth, until=1.0, **run)
            with self.subTest(plain.method):
                whole = qddot.solve(cloth, plain.method, **saved, **{plain.knob: plain.value})
                q, v = plain(TIMES)
                self.assertTrue(np.array_equal(q[:-1], whole.q[:-1]))
                self.assertTrue(np.array_equal(v[:-1], whole.v[:-1]))
                self.assertTrue(np.array_equal(q[-1], plain.end.q))
                # In any order, and in the shape of the times.
                turned = plain(TIMES[::-1].reshape(1, -1))[0]
                self.assertTrue(np.array_equal(turned[0, ::-1], q))
        q, v = whole(0.0)
        self.assertTrue(np.array_equal(q, whole.q[0]))
        self.assertEqual(whole([])[0].shape, (0, 16, 3))

    def test_what_no_run_reached_is_refused(self):
        failed = qddot.solve(HARMONIC, "verlet", step_size=1.5, q0=[1.0], until=1e4)
        self.assertEqual(failed.outcome, "diverged")
        self.assertTrue(np.array_equal(failed(failed.t_reached)[0], failed.end.q))
        self.assertTrue(np.all(np.isfinite(failed(failed.t_reached / 2)[0])))
        stopped = qddot.solve(HARMONIC, "verlet", step_size=1e-6, q0=[1.0], until=1e6, seconds=0.2)
        self.assertEqual(stopped.outcome, "over_budget")
        self.assertIn("(seconds = 0.2)", stopped.message)
        middle = stopped.t_reached / 2
        self.assertAlmostEqual(stopped(middle)[0][0], np.cos(2 * middle), delta=1e-6)
        for t in (-0.1, stopped.t_reached * 1.1, np.nan):
            with self.assertRaisesRegex(ValueError, "t: allowed are times from 0 to t_reached"):
                stopped(t)
        with self.assertRaisesRegex(ValueError, "no run is known to repeat"):
            pickle.loads(pickle.dumps(failed))(0.0)


class Along(unittest.TestCase):
    def test_errors_at_all_times_are_those_of_references_to_each(self):
        chain = problems.Chain(3)
        (q0, v0), scene, system = chain.start(), chain.scene(), chain.system()
        times = np.array([0.0, 0.21, 0.5, 1.0])
        for of, start in ((scene, {}), (system, dict(q0=q0, v0=v0))):
            exact = qddot.reference(of, 1.0, **start)
            run = dict(step_size=0.02, until=1.0, save_at=times, **start)
            sol = qddot.solve(of, "verlet", **run)
            along = exact.errors_along(sol)
            self.assertTrue(np.array_equal(along.t, times))
            self.assertEqual(along.position[0], 0)
            self.assertEqual(along.position[-1], exact.errors(sol).position)
            self.assertEqual(along.velocity[-1], exact.errors(sol).velocity)
            self.assertEqual(along.certified[-1], exact.certified.position)
            self.assertTrue(np.all(along.certified < 1e-9))
            scale = float(exact.divided_by.split("node, ")[1].split(" m")[0])
            for k in (1, 2):
                own = qddot.reference(of, times[k], **start)
                far = np.max(np.linalg.norm(sol.q[k] - own.q, axis=1))
                # `divided_by` has three digits.
                self.assertAlmostEqual(along.position[k] * scale / far, 1, delta=1e-2)
            other = exact.errors_along(times, sol.q, sol.v)
            self.assertTrue(np.array_equal(other.position, along.position))
            self.assertTrue(np.all(np.isnan(exact.errors_along(times, sol.q).velocity)))
        self.assertIn("4 times up to 1 s", repr(along))

    def test_a_linear_motion_is_known_along_its_way(self):
        exact = qddot.reference(HARMONIC, 3.0, q0=[1.0])
        times = np.linspace(0, 3, 20)
        q = np.cos(2 * times)[:, None]
        along = exact.errors_along(times, q, -2 * np.sin(2 * times)[:, None])
        self.assertTrue(np.all(along.position <= along.certified), along)
        wrong = exact.errors_along(times, q + 1e-3)
        # Over the largest displacement, 2.
        self.assertTrue(np.allclose(wrong.position, 5e-4, rtol=1e-6))

    def test_errors_know_their_time(self):
        exact = qddot.reference(HARMONIC, 0.3, q0=[1.0])
        q, v = np.cos([0.6]), -2 * np.sin([0.6])
        self.assertLess(exact.errors(q, v, t=0.1 + 0.2).position, 1e-12)
        with self.assertRaisesRegex(ValueError, "ends at t = 0.2 s, .* 0.3 s; errors_along"):
            exact.errors(q, v, t=0.2)
        with self.assertWarnsRegex(RuntimeWarning, "taken for those at 0.3 s") as warned:
            exact.errors(q, v)
        self.assertEqual(warned.filename, __file__)
        run = dict(q0=[1.0], step_size=0.1, until=0.4, save_at=[0.1, 0.4])
        sol = qddot.solve(HARMONIC, "verlet", **run)
        with self.assertRaisesRegex(ValueError, "ends at t = 0.4 s"):
            exact.errors(sol)
        with self.assertRaisesRegex(ValueError, "t: its times must ascend from 0 to until = 0.3 s"):
            exact.errors_along(sol)
        for sentence, given in {
            "q is missing": ([0.1],),
            r"q has the shape \(1,\); allowed is that of all nodes, \(1, 1\)": ([0.1], [1.0]),
            r"v has the shape": ([0.1], [[1.0]], [1.0]),
        }.items():
            with self.assertRaisesRegex(ValueError, sentence):
                exact.errors_along(*given)

    def test_too_little_time_names_its_argument(self):
        scene = qddot.scenes.lattice()
        for call, name in (
            (lambda: qddot.reference(scene, 1e4, seconds=0.1), "seconds"),
            (
                lambda: qddot.work_precision(scene, 1e4, ["verlet"], reference_seconds=0.1),
                "reference_seconds",
            ),
            (
                lambda: qddot.convergence(scene, "verlet", 1e-3, until=1e4, reference_seconds=0.1),
                "reference_seconds",
            ),
        ):
            with self.assertRaisesRegex(
                qddot.NoReference, rf"an earlier end \(until\), or for more time \({name} = 0.1\)$"
            ):
                call()


if __name__ == "__main__":
    unittest.main()
