"""Callables: what they see, keep and raise."""

import gc
import traceback
import unittest
import weakref

import numpy as np

import problems
import qddot


class Callables(unittest.TestCase):
    def test_calls_see_the_solvers_memory(self):
        seen = set()

        def force(q, f):
            for name, a in (("q", q), ("f", f)):
                is_so = a.flags.c_contiguous, a.flags.writeable, a.flags.owndata
                seen.add((name, a.shape, a.dtype, *is_so))
            return np.negative(q, out=f)  # as functions of NumPy do

        system = qddot.System(np.ones(4), force, dimension=3)
        solution = qddot.solve(system, "verlet", step_size=0.1, until=1, q0=np.ones((4, 3)))
        kind = (4, 3), np.dtype(float), True
        self.assertEqual(seen, {("q", *kind, False, False), ("f", *kind, True, False)})
        self.assertEqual(solution.q.shape, (1, 4, 3))

    def test_results_are_views_into_one_buffer(self):
        scene = qddot.scenes.cloth(nodes=4)
        solution = qddot.solve(scene, "verlet", step_size=1e-3, until=0.1, save_at=[0, 0.05, 0.1])
        self.assertEqual(solution.q.shape, (3, 16, 3))
        self.assertIs(solution.q.base, solution.v.base)
        for array in (solution.q, solution.v, scene.positions):
            self.assertTrue(array.flags.c_contiguous and array.dtype == np.float64)
        # The way back from what is left of a scene takes some roundings.
        self.assertLess(np.max(np.abs(solution.q[0] - scene.positions)), 1e-15)

    def test_a_system_is_what_it_was_made_of(self):
        mass = np.ones(1)
        system = qddot.System(mass, lambda q, f: np.copyto(f, -q))
        run = dict(step_size=0.01, until=1.0, q0=[1.0])
        before = qddot.solve(system, "verlet", **run).end.q
        mass[:] = 100
        self.assertTrue(np.array_equal(qddot.solve(system, "verlet", **run).end.q, before))
        with self.assertRaises(AttributeError):
            system.mass = mass
        with self.assertRaises(ValueError):
            system.mass[0] = 2

    def test_a_callable_may_catch_what_a_run_within_it_raises(self):
        def bad(q, f):
            raise RuntimeError("inner")

        inner, caught = qddot.System([1.0], bad), []

        def outer(q, f):
            try:
                qddot.solve(inner, "rk4", step_size=0.1, q0=[1.0], until=1.0)
            except RuntimeError:
                caught.append(1)
            np.copyto(f, -q)

        for check in (True, False):
            system = qddot.System([1.0], outer, check=check)
            solution = qddot.solve(system, "rk4", step_size=0.1, q0=[1.0], until=1.0)
            self.assertEqual(solution.outcome, "reached_end")
        self.assertGreater(len(caught), 40)

    def test_cycles_are_collected(self):
        class Owner:
            def __init__(self):
                self.system = qddot.System(np.ones(3), self.force)
                run = dict(step_size=0.1, until=1, q0=np.ones(3))
                self.solution = qddot.solve(self.system, "verlet", **run)

            def force(self, q, f):
                f[:] = -q

        owner = weakref.ref(Owner())
        gc.collect()
        self.assertIsNone(owner())

    def test_a_solution_keeps_what_its_diagnosis_calls(self):
        def made():
            import ctypes

            kind = ctypes.CFUNCTYPE(None, ctypes.POINTER(ctypes.c_double),
                                    ctypes.POINTER(ctypes.c_double), ctypes.c_int64)  # fmt: skip
            force = kind(lambda q, f, n: f.__setitem__(0, -q[0]))
            return qddot.System([1.0], force, lambda q: q @ q / 2, pattern="dense")

        failed = qddot.solve(made(), "verlet", step_size=10.0, q0=[1.0], until=1e4)
        gc.collect()
        self.assertEqual(failed.outcome, "diverged")
        self.assertIn("verlet", failed.diagnosis())
        plain = qddot.System([1.0], lambda q, f: np.copyto(f, -q))
        failed = qddot.solve(plain, "verlet", step_size=10.0, q0=[1.0], until=1e4)
        self.assertEqual(failed.diagnosis(), "")

    def test_what_is_kept_is_refused(self):
        kept = []

        for name, part in {"q": lambda q, f: q, "f": lambda q, f: f[:1]}.items():
            with self.subTest(name):

                def force(q, f):
                    kept.append(part(q, f))
                    f[:] = -q

                system = qddot.System(np.ones(2), force, check=False)
                sentence = rf"force: it kept {name} .*{name}\.copy\(\)"
                with self.assertRaisesRegex(RuntimeError, sentence):
                    qddot.solve(system, "verlet", step_size=0.1, until=1, q0=[1.0, 2.0])
        # An array that was kept whole has become a copy, which nobody else writes to.
        self.assertTrue(np.array_equal(kept[0], [1.0, 2.0]) and kept[0].base is not None)
        kept.clear()

    def test_what_a_callable_raises_is_raised(self):
        class Mine(Exception):
            pass

        calls = 0

        def force(q, f):
            nonlocal calls
            calls += 1
            if calls == 50:
                raise Mine("at the fiftieth")
            f[:] = -q - q**3

        def inner(q):
            raise Mine("in K")

        system = qddot.System(np.ones(2), force, problems.duffing_potential, pattern="dense")
        methods = "verlet rk4 implicit_midpoint arkode_erk4 arkode_dirk4 cvode_bdf ida"
        for method in methods.split():
            with self.subTest(method):
                calls = 0
                knob = "step_size" if qddot.method(method).knob == "step_size" else "rtol"
                run = dict(until=5.0, q0=[1.0, 0.5], **{knob: 1e-3})
                try:  # assertRaises would empty the traceback
                    qddot.solve(system, method, **run)
                    self.fail("nothing was raised")
                except Mine as error:
                    self.assertEqual(str(error), "at the fiftieth")
                    names = [frame.name for frame in traceback.extract_tb(error.__traceback__)]
                self.assertEqual(names[-1], "force")
                # Nothing is damaged: the same system runs on.
                self.assertEqual(qddot.solve(system, method, **run).outcome, "reached_end")
        bad = qddot.System(
            np.ones(2), problems.duffing_force, None, inner, pattern="dense", check=False
        )
        with self.assertRaisesRegex(Mine, "in K"):
            qddot.solve(bad, "arkode_dirk4", rtol=1e-4, until=1.0, q0=[1.0, 0.5])
        # Within a study that makes many runs, too.
        for study in (
            lambda: qddot.solve(system, accuracy=1e-4, until=5.0, q0=[1.0, 0.5]),
            lambda: qddot.work_precision(system, 5.0, ["verlet"], q0=[1.0, 0.5]),
            lambda: qddot.reference(system, 5.0, q0=[1.0, 0.5]),
        ):
            calls = 0
            with self.assertRaisesRegex(Mine, "fiftieth"):
                study()

    def test_what_a_library_takes_for_its_own_failure_is_raised_all_the_same(self):
        # If a largest frequency is not found, only the margin of stability is unknown.
        is_armed = False

        def stiffness(q):
            if is_armed:
                raise KeyboardInterrupt
            return problems.duffing_stiffness(q)

        def arm(_):
            nonlocal is_armed
            is_armed = True

        forces = problems.duffing_force, problems.duffing_potential, stiffness
        system = qddot.System(np.ones(2), *forces)
        with self.assertRaises(KeyboardInterrupt):
            qddot.work_precision(
                system, 1.0, ["verlet"], q0=[1.0, 0.5], point_limit=0.05, progress=arm
            )

    def test_a_traceback_holds_no_memory_of_the_solver(self):
        def force(q, f):
            if q[0] < 0.5:
                raise ValueError("far enough")
            f[:] = -q

        n = 200_000  # so many that the memory goes back to the system when the run is over
        system = qddot.System(np.ones(n), force)
        try:
            qddot.solve(system, "verlet", step_size=0.01, until=3, q0=np.ones(n))
        except ValueError as error:
            frame = error.__traceback__
            while frame.tb_next:
                frame = frame.tb_next
            q = frame.tb_frame.f_locals["q"]
        gc.collect()
        # Whoever takes the memory next writes into it.
        others = [np.full(n, 7.0) for _ in range(50)]
        qddot.solve(system, "verlet", step_size=0.01, until=0.1, q0=others[0])
        self.assertTrue(0.4 < q.min() == q.max() < 0.5)
