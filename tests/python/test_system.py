"""An own M q'' = f(q): by callables and by C functions, with and without V and K."""

import gc
import traceback
import unittest
import warnings
import weakref

import numpy as np
import scipy.sparse

import problems
import qddot

SECONDS = 0.2


class OwnForces(unittest.TestCase):
    def test_a_system_is_the_scene_that_it_describes(self):
        # Two codes of one motion: NumPy's sums are in another order, and errors grow by some
        # roundings a step.
        chain = problems.Chain(5)
        scene, (q0, v0) = chain.scene(), chain.start()
        for method in qddot.methods():
            if method.name == "exact" or set(method.needs) - {"stiffness"}:
                continue
            knob = {"step_size": 1e-3} if method.knob == "step_size" else {"rtol": 1e-8}
            with self.subTest(method=method.name):
                # As drawn: nothing is left out of a System.
                keep = ["dimension", "mirror", "constant_stiffness"]
                a = qddot.solve(scene, method.name, until=SECONDS, keep=keep, **knob).or_raise()
                b = qddot.solve(chain.system(), method.name, until=SECONDS, q0=q0, v0=v0, **knob)
                self.assertEqual(b.outcome, "reached_end")
                difference = np.max(np.abs(a.end.q[1:-1] - b.end.q))
                # Adaptive methods may take other steps where an error test is that near; and
                # linear_midpoint asks springs for their material stiffness, which no System says.
                is_other = method.knob == "rtol" or method.name == "linear_midpoint"
                self.assertLess(difference, 1e-6 if is_other else 1e-10)
                self.assertLess(abs(a.energy.total[-1] - b.energy.total[-1]), 1e-6)

    def test_the_session_of_the_readme(self):
        duffing = qddot.System(
            mass=[1.0],
            force=lambda q, f: np.copyto(f, -q - q**3),
            potential=lambda q: q @ q / 2 + (q**4).sum() / 4,
        )
        solution = qddot.solve(duffing, "dprkn8", rtol=1e-10, q0=[1.0], v0=[0.0], until=100.0)
        solution.or_raise()
        self.assertEqual(solution.q.shape, (1, 1))
        # q'^2/2 + V(q) = 3/4 all the way.
        self.assertAlmostEqual(solution.energy.total[0], 0.75, delta=1e-8)

    def test_c_functions_are_the_callables(self):
        import cffi
        import ctypes

        library = problems.library(problems.DUFFING_C)
        library.potential.restype = ctypes.c_double
        ffi = cffi.FFI()
        ffi.cdef(
            "void force(const double*, double*, int64_t); double potential(const double*, int64_t);"
        )
        other = ffi.dlopen(library._name)
        cases = {
            "ctypes": (library.force, library.potential),
            "cffi": (
                ffi.addressof(other, "force"),
                ffi.addressof(other, "potential"),
            ),
        }
        try:
            import numba
        except ImportError:
            pass
        else:
            pointer, whole = numba.types.CPointer(numba.types.float64), numba.types.int64

            @numba.cfunc(numba.types.void(pointer, pointer, whole))
            def force(q, f, n):
                for i in range(n):
                    f[i] = -q[i] - q[i] * q[i] * q[i]

            @numba.cfunc(numba.types.float64(pointer, whole))
            def potential(q, n):
                v = 0.0
                for i in range(n):
                    v += q[i] * q[i] / 2 + q[i] * q[i] * q[i] * q[i] / 4
                return v

            cases["numba"] = force, potential

        def plain(q, f):
            f[:] = -q - q * q * q

        q0 = np.array([1.0, -0.5, 0.25])
        run = dict(rtol=1e-9, q0=q0, until=20.0)
        expected = qddot.solve(
            qddot.System(np.ones(3), plain, problems.duffing_potential), "dprkn8", **run
        )
        for name, (f, v) in cases.items():
            with self.subTest(name):
                solution = qddot.solve(qddot.System(np.ones(3), f, v), "dprkn8", **run)
                self.assertTrue(np.array_equal(solution.end.q, expected.end.q))
                self.assertAlmostEqual(
                    solution.energy.total[0], expected.energy.total[0], delta=1e-14
                )
                dense = qddot.System(np.ones(3), f, v, pattern=np.eye(3))
                self.assertEqual(
                    qddot.solve(dense, "implicit_midpoint", step_size=0.01, q0=q0, until=1).outcome,
                    "reached_end",
                )

    def test_what_is_missing_decides_what_is_offered(self):
        q0, knobs = np.array([1.0, 0.5]), {"step_size": {"step_size": 1e-2}, "rtol": {"rtol": 1e-5}}
        systems = {
            "force": qddot.System(np.ones(2), problems.duffing_force),
            "potential": qddot.System(
                np.ones(2), problems.duffing_force, problems.duffing_potential
            ),
            "stiffness": qddot.System(
                np.ones(2),
                problems.duffing_force,
                problems.duffing_potential,
                problems.duffing_stiffness,
            ),
            "pattern": qddot.System(np.ones(2), problems.duffing_force, pattern=np.eye(2)),
        }
        for name, system in systems.items():
            for method in qddot.methods():
                run = dict(until=1.0, q0=q0, **knobs[method.knob])
                others = set(method.needs) - {"stiffness"}
                with self.subTest(system=name, method=method.name):
                    if others or ("stiffness" in method.needs and not system.has_stiffness):
                        with self.assertRaisesRegex(ValueError, method.name):
                            qddot.solve(system, method.name, **run)
                        continue
                    solution = qddot.solve(system, method.name, **run).or_raise()
                    self.assertEqual(solution.energy is None, not system.has_potential)
                    self.assertTrue(np.all(np.isfinite(solution.q)))
        for what, call in {
            "accuracy": lambda s: qddot.solve(s, accuracy=1e-3, until=1.0, q0=q0),
            "reference": lambda s: qddot.reference(s, 1.0, q0=q0),
            "work_precision": lambda s: qddot.work_precision(
                s, 1.0, ["verlet"], q0=q0, point_limit=0.1
            ),
            "advise": lambda s: qddot.advise(s, 1e-3, until=1.0, q0=q0),
        }.items():
            with self.subTest(what):
                with self.assertRaisesRegex(ValueError, f"{what}.*potential"):
                    call(systems["force"])
                with self.assertRaisesRegex(ValueError, f"{what}.*stiffness"):
                    call(systems["potential"])
                call(systems["stiffness"])

    def test_stiffness_in_every_form(self):
        chain = problems.Chain(6)
        q0, v0 = chain.start()
        dense = chain.system()

        def solved(system):
            run = dict(step_size=5e-3, until=SECONDS, q0=q0, v0=v0)
            return qddot.solve(system, "implicit_midpoint", **run).or_raise().end.q

        expected = solved(dense)
        for form in (
            "csr_matrix",
            "csc_matrix",
            "coo_matrix",
            "lil_matrix",
            "csr_array",
            "bsr_matrix",
        ):
            with self.subTest(form):
                make = getattr(scipy.sparse, form)
                system = chain.system(stiffness=lambda q, make=make: make(chain.stiffness(q)))
                self.assertTrue(np.array_equal(solved(system), expected))
        # A matrix that its owner fills again and again stays as its owner left it.
        kept = scipy.sparse.csr_matrix(chain.stiffness(q0))
        first = slice(0, kept.indptr[1])
        self.assertGreater(kept.indptr[1], 1)
        kept.indices[first] = kept.indices[first][::-1].copy()
        kept.data[first] = kept.data[first][::-1].copy()
        kept.has_sorted_indices = False
        kept.has_canonical_format = False
        before = kept.indices.copy()
        system = chain.system(stiffness=lambda q: kept, check=False)
        qddot.solve(
            system, "semi_implicit_euler", step_size=1e-3, until=0.01, q0=q0, v0=v0
        ).or_raise()
        self.assertTrue(np.array_equal(kept.indices, before))

        # By differences, good to some 1e-10 of the largest entries; its pattern by nodes or unknowns.
        nodes = scipy.sparse.diags([1, 1, 1], [-1, 0, 1], (6, 6))
        unknowns = np.kron(nodes.toarray(), np.ones((2, 2)))
        pairs = np.argwhere(unknowns)
        for name, pattern in {
            "nodes": nodes,
            "unknowns": unknowns,
            "pairs": pairs,
            "all": "dense",
        }.items():
            with self.subTest(name):
                system = chain.system(stiffness=None, pattern=pattern)
                self.assertLess(np.max(np.abs(solved(system) - expected)), 1e-9)
        stencil = chain.system(stiffness=None, pattern=nodes)
        counts = qddot.solve(
            stencil, "implicit_midpoint", step_size=5e-3, until=SECONDS, q0=q0, v0=v0
        ).counts
        self.assertGreater(counts.stiffness_evaluations, 0)

    def test_calls_see_the_solvers_memory(self):
        seen = {}

        def force(q, f):
            seen.update(
                shape=(q.shape, f.shape), order=(q.flags.c_contiguous, f.flags.c_contiguous),
                write=(q.flags.writeable, f.flags.writeable), own=(q.flags.owndata, f.flags.owndata),
                kind=(q.dtype, f.dtype),
            )  # fmt: skip
            f[:] = -q

        system = qddot.System(np.ones(4), force, dimension=3)
        solution = qddot.solve(system, "verlet", step_size=0.1, until=1, q0=np.ones((4, 3)))
        self.assertEqual(seen["shape"], ((4, 3), (4, 3)))
        self.assertEqual(seen["order"], (True, True))
        self.assertEqual(seen["write"], (False, True))
        self.assertEqual(seen["own"], (False, False))
        self.assertEqual(seen["kind"], (np.float64, np.float64))
        self.assertEqual(solution.q.shape, (1, 4, 3))

    def test_functions_of_numpy_return_what_they_wrote(self):
        system = qddot.System(np.ones(2), lambda q, f: np.negative(q, out=f))
        qddot.solve(system, "verlet", step_size=0.1, until=1, q0=np.ones(2)).or_raise()

    def test_results_are_views_into_one_buffer(self):
        scene = qddot.scenes.cloth(nodes=4)
        solution = qddot.solve(scene, "verlet", step_size=1e-3, until=0.1, save_at=[0, 0.05, 0.1])
        self.assertEqual(solution.q.shape, (3, 16, 3))
        self.assertIs(solution.q.base, solution.v.base)
        for array in (solution.q, solution.v, scene.positions):
            self.assertTrue(array.flags.c_contiguous and array.dtype == np.float64)
        # The way back from what is left of a scene takes some roundings.
        self.assertLess(np.max(np.abs(solution.q[0] - scene.positions)), 1e-15)

    def test_without_times_the_state_that_was_reached_is_returned(self):
        system = qddot.System([1.0], problems.duffing_force, problems.duffing_potential)
        failed = qddot.solve(system, "verlet", step_size=10.0, q0=[1e3], until=1e3)
        self.assertEqual(failed.outcome, "diverged")
        self.assertEqual(failed.q.shape, (1, 1))
        self.assertEqual(failed.t[0], failed.t_reached)
        none = qddot.solve(system, "verlet", step_size=0.1, q0=[1.0], until=1.0, save_at=[])
        self.assertEqual((none.q.shape, len(none.energy.total)), ((0, 1), 0))
        times = np.arange(0, 0.31, 0.1)  # whose last is a rounding beyond 0.3
        self.assertGreater(times[-1], 0.3)
        seen = qddot.solve(system, "verlet", step_size=0.1, q0=[1.0], until=0.3, save_at=times)
        self.assertEqual(seen.t[-1], 0.3)

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

    def test_broken_matrices_are_refused(self):
        k = scipy.sparse.csr_matrix(np.array([[-1.0, 0.5], [0.5, -1.0]]))
        k.indptr[1] = -5
        k.has_sorted_indices = k.has_canonical_format = True
        system = qddot.System(np.ones(2), lambda q, f: np.copyto(f, -q), None, lambda q: k, "dense")
        with self.assertRaisesRegex(ValueError, "indptr"):
            qddot.solve(system, "implicit_euler", step_size=0.1, q0=[1.0, 2.0], until=1.0)

    def test_cycles_are_collected(self):
        class Owner:
            def __init__(self):
                self.system = qddot.System(np.ones(3), self.force)
                self.solution = qddot.solve(
                    self.system, "verlet", step_size=0.1, until=1, q0=np.ones(3)
                )

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
        self.assertEqual(
            qddot.solve(plain, "verlet", step_size=10.0, q0=[1.0], until=1e4).diagnosis(), ""
        )

    def test_what_is_kept_is_refused(self):
        kept = []

        def keeps_q(q, f):
            kept.append(q)
            f[:] = -q

        def keeps_part(q, f):
            kept.append(f[:1])
            f[:] = -q

        for force, name in ((keeps_q, "q"), (keeps_part, "f")):
            with self.subTest(name):
                system = qddot.System(np.ones(2), force, check=False)
                with self.assertRaisesRegex(
                    RuntimeError, rf"force: it kept {name} .*{name}\.copy\(\)"
                ):
                    qddot.solve(system, "verlet", step_size=0.1, until=1, q0=[1.0, 2.0])
        # What was kept whole has become a copy, which nobody else writes to.
        self.assertTrue(np.array_equal(kept[0], [1.0, 2.0]) and kept[0].base is not None)
        kept.clear()

    def test_wrong_callables_are_refused(self):
        def of(force, potential=None, stiffness=None, **more):
            system = qddot.System(np.ones(2), force, potential, stiffness, **more)
            return lambda: qddot.solve(system, "verlet", step_size=0.1, until=1, q0=[1.0, 0.5])

        good = problems.duffing_force
        cases = {
            "f is -dV/dq": of(good, lambda q: -problems.duffing_potential(q)),
            "stiffness.*the other sign": of(good, None, lambda q: -problems.duffing_stiffness(q)),
            "stiffness: beside the start it is not df/dq": of(
                good, None, lambda q: 2 * problems.duffing_stiffness(q)
            ),
            "stiffness: .*allowed is 2 x 2": of(good, None, lambda q: np.eye(3)),
            "force: it returned something": of(lambda q, f: -q),
            "is it written": of(lambda q, f: f.fill(np.nan)),
        }
        for sentence, call in cases.items():
            with self.subTest(sentence):
                with self.assertRaisesRegex(ValueError, sentence):
                    call()
        with self.assertRaises(TypeError):
            of(good, lambda q: "much")()
        # Entries beyond the pattern of the first K.
        grows = qddot.System(
            np.ones(2), good, None, lambda q: np.array([[-1, q[0]], [q[0], -1]]), check=False,
            pattern=np.eye(2),
        )  # fmt: skip
        with self.assertRaisesRegex(ValueError, r"entry \(1, 0\).*pattern="):
            qddot.solve(grows, "implicit_euler", step_size=0.1, until=1, q0=[1.0, 0.5])

    def test_small_things_are_looked_at_by_their_own_size(self):
        # Atoms, 1e-10 m apart, in SI units: V = e ((s/r)^12 - 2 (s/r)^6).
        e, s = 1e-21, 3e-10

        def force(q, f):
            d = q[1] - q[0]
            r = np.linalg.norm(d)
            f[0] = 12 * e / r**2 * ((s / r) ** 6 - (s / r) ** 12) * d
            f[1] = -f[0]

        def potential(q):
            p = (s / np.linalg.norm(q[1] - q[0])) ** 6
            return e * (p * p - 2 * p)

        atoms = qddot.System([6e-26, 6e-26], force, potential, dimension=3, pattern="dense")
        q0 = np.array([[0.0, 0.0, 0.0], [3.3e-10, 0.0, 0.0]])
        a = qddot.solve(atoms, "blanes_moan4", step_size=2e-15, until=2e-12, q0=q0).or_raise()
        b = qddot.solve(atoms, "implicit_midpoint", step_size=2e-15, until=2e-12, q0=q0).or_raise()
        self.assertLess(abs(a.energy.total[0] / potential(q0) - 1), 1e-6)
        self.assertLess(np.max(np.abs(a.end.q - b.end.q)), 1e-3 * s)

    def test_velocities_are_refused_by_what_would_ignore_them(self):
        with self.assertRaisesRegex(ValueError, r"force\(q, f\).*velocity"):
            qddot.System([1.0], lambda q, v, f: np.copyto(f, -q - v))
        with self.assertRaisesRegex(ValueError, r"potential\(q\)"):
            qddot.System([1.0], problems.duffing_force, lambda q, v: 0.0)
        with self.assertRaisesRegex(ValueError, r"stiffness\(q\)"):
            qddot.System([1.0], problems.duffing_force, None, lambda t, q: 0.0)
        scene = qddot.scenes.cloth(nodes=4)
        for name, other in (("q0", "positions"), ("v0", "velocities")):
            with self.assertRaisesRegex(ValueError, f"{name} is for a System.*{other}"):
                qddot.solve(scene, "verlet", step_size=1e-3, until=0.1, **{name: scene.positions})
        for ignores in (qddot.equilibrium, qddot.modes):
            with self.assertRaises(TypeError):
                ignores(qddot.System([1.0], problems.duffing_force), q0=[1.0], v0=[1.0])

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
        for method in (
            "verlet",
            "rk4",
            "implicit_midpoint",
            "arkode_erk4",
            "arkode_dirk4",
            "cvode_bdf",
            "ida",
        ):
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
        # Where a largest frequency is not found, no margin of stability is known, and that is all.
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

    def test_a_run_within_a_run(self):
        inner = qddot.System([1.0], problems.duffing_force)

        def force(q, f):
            end = qddot.solve(inner, "verlet", step_size=0.1, until=1, q0=q).end.q
            f[:] = -end

        outer = qddot.System([1.0], force)
        self.assertEqual(
            qddot.solve(outer, "verlet", step_size=0.1, until=1, q0=[1.0]).outcome, "reached_end"
        )

    def test_own_systems_are_measured(self):
        chain = problems.Chain(4)
        q0, v0 = chain.start()
        system, scene = chain.system(), chain.scene()
        start = dict(q0=q0, v0=v0)
        a, b = qddot.reference(system, 1.0, **start), qddot.reference(scene, 1.0)
        self.assertLess(np.max(np.abs(a.q - b.q[1:-1])), 1e-9)
        answer = qddot.solve(system, accuracy=1e-5, until=1.0, **start).or_raise()
        self.assertLess(a.errors(answer).position, answer.error_estimate)
        chart = qddot.work_precision(system, 1.0, ["verlet", "rodas4"], point_limit=0.2, **start)
        self.assertLess(chart.best(1e-2).error_position, 1e-2)
        self.assertTrue(np.allclose(qddot.equilibrium(system, q0).positions, q0, atol=1e-9))
        w = qddot.modes(system, 8, q0).omega
        self.assertTrue(np.allclose(w[4:], qddot.modes(scene, 8).omega[4:], rtol=1e-9))
        # Fixed ends, along the chain: w_j = 2 sqrt(k/m) sin(j pi / (2 (n + 1))); across none.
        exact = 2 * 10 * np.sin(np.arange(1, 5) * np.pi / 10)
        self.assertTrue(np.allclose(w[4:], exact, rtol=1e-9))
        limit = qddot.stability_limit("verlet", system, q0)
        self.assertAlmostEqual(limit.step_size, 2 / exact[-1], delta=1e-3 * limit.step_size)
        order = qddot.convergence(
            system, "blanes_moan4", 0.02, 5, until=1.0, reference=a, **start
        ).order
        # The last errors are within 20 times of what the reference certifies.
        self.assertLess(np.max(np.abs(order[np.isfinite(order)] - 4)), 0.1)
        self.assertGreater(np.count_nonzero(np.isfinite(order)), 2)


class Growth(unittest.TestCase):
    def test_a_run_that_grows_warns(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            qddot.solve(qddot.scenes.oscillator(), "explicit_euler", step_size=0.003, until=9)
        self.assertTrue(any("energy" in str(w.message) for w in caught))


if __name__ == "__main__":
    unittest.main()
