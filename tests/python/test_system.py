"""An own M q'' = f(q): by callables and by C functions, with and without V and K."""

import ctypes
import unittest

import numpy as np
import problems
import qddot
from problems import needs_scipy, scipy

SECONDS = 0.2


class OwnForces(unittest.TestCase):
    def test_a_system_is_the_scene_that_it_describes(self):
        # Two codes of one motion: NumPy's sums are in another order, and errors grow by some
        # roundings a step.
        chain = problems.Chain(5)
        scene, (q0, v0) = chain.scene(), chain.start()
        for method in qddot.methods():
            if method.name == "exact" or set(method.needs) - {"stiffness", "potential"}:
                continue
            knob = {"step_size": 1e-3} if method.knob == "step_size" else {"rtol": 1e-8}
            with self.subTest(method=method.name):
                # As drawn: nothing is left out of a System.
                keep = ["dimension", "mirror", "constant_stiffness"]
                a = qddot.solve(scene, method.name, until=SECONDS, keep=keep, **knob).or_raise()
                b = qddot.solve(chain.system(), method.name, until=SECONDS, q0=q0, v0=v0, **knob)
                self.assertEqual(b.outcome, "reached_end")
                difference = np.max(np.abs(a.end.q[1:-1] - b.end.q))
                # Adaptive methods may take other steps if an error test is very close.
                # linear_midpoint needs the material stiffness of springs, which no System has.
                is_other = method.knob == "rtol" or method.name == "linear_midpoint"
                self.assertLess(difference, 1e-6 if is_other else 1e-10)
                self.assertLess(abs(a.energy.total[-1] - b.energy.total[-1]), 1e-6)

    def test_c_functions_are_the_callables(self):
        library = problems.compiled(problems.DUFFING_C)
        library.potential.restype = ctypes.c_double
        cases = {"ctypes": (library.force, library.potential)}
        try:
            import cffi
        except ImportError:
            pass
        else:
            ffi = cffi.FFI()
            ffi.cdef(
                "void force(const double*, double*, int64_t);"
                "double potential(const double*, int64_t);"
            )
            other = ffi.dlopen(library._name)
            cases["cffi"] = ffi.addressof(other, "force"), ffi.addressof(other, "potential")
        try:
            import numba
        except ImportError:
            pass
        else:

            @numba.cfunc("void(CPointer(float64), CPointer(float64), int64)")
            def force(q, f, n):
                for i in range(n):
                    f[i] = -q[i] - q[i] * q[i] * q[i]

            @numba.cfunc("float64(CPointer(float64), int64)")
            def potential(q, n):
                v = 0.0
                for i in range(n):
                    v += q[i] * q[i] / 2 + q[i] * q[i] * q[i] * q[i] / 4
                return v

            cases["numba"] = force, potential

        q0, ones = np.array([1.0, -0.5, 0.25]), np.ones(3)
        run = dict(rtol=1e-10, q0=q0, until=20.0)
        duffing = qddot.System(ones, problems.duffing_force, problems.duffing_potential)
        expected = qddot.solve(duffing, "dprkn8", **run)
        # q'^2/2 + V(q) all the way.
        energy = problems.duffing_potential(q0)
        self.assertAlmostEqual(expected.energy.total[-1], energy, delta=1e-8)
        for name, (f, v) in cases.items():
            with self.subTest(name):
                solution = qddot.solve(qddot.System(ones, f, v), "dprkn8", **run)
                self.assertTrue(np.array_equal(solution.end.q, expected.end.q))
                difference = solution.energy.total[0] - expected.energy.total[0]
                self.assertLess(abs(difference), 1e-14)
                dense = qddot.System(ones, f, v, pattern=np.eye(3))
                run_of_k = dict(step_size=0.01, q0=q0, until=1)
                qddot.solve(dense, "implicit_midpoint", **run_of_k).or_raise()

    def test_what_is_missing_decides_what_is_offered(self):
        q0, knobs = np.array([1.0, 0.5]), {"step_size": {"step_size": 1e-2}, "rtol": {"rtol": 1e-5}}
        forces = problems.duffing_force, problems.duffing_potential, problems.duffing_stiffness
        systems = {
            "force": qddot.System(np.ones(2), forces[0]),
            "potential": qddot.System(np.ones(2), *forces[:2]),
            "stiffness": qddot.System(np.ones(2), *forces),
            "pattern": qddot.System(np.ones(2), forces[0], pattern=np.eye(2)),
        }
        for name, system in systems.items():
            for method in qddot.methods():
                run = dict(until=1.0, q0=q0, **knobs[method.knob])
                missing = set(method.needs)
                missing -= {"stiffness"} if system.has_stiffness else set()
                missing -= {"potential"} if system.has_potential else set()
                with self.subTest(system=name, method=method.name):
                    if missing:
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

    @needs_scipy
    def test_stiffness_in_every_form(self):
        chain = problems.Chain(6)
        q0, v0 = chain.start()
        dense = chain.system()

        def solved(system):
            run = dict(step_size=5e-3, until=SECONDS, q0=q0, v0=v0)
            return qddot.solve(system, "implicit_midpoint", **run).or_raise().end.q

        expected = solved(dense)
        forms = "csr_matrix csc_matrix coo_matrix lil_matrix csr_array bsr_matrix"
        for form in forms.split():
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
        kept.has_sorted_indices = kept.has_canonical_format = False
        before = kept.indices.copy()
        system = chain.system(stiffness=lambda q: kept, check=False)
        run = dict(step_size=1e-3, until=0.01, q0=q0, v0=v0)
        qddot.solve(system, "semi_implicit_euler", **run).or_raise()
        self.assertTrue(np.array_equal(kept.indices, before))

        # K by differences is right to some 1e-10 of the largest entries; its pattern is by nodes or
        # unknowns.
        nodes = scipy.sparse.diags([1, 1, 1], [-1, 0, 1], (6, 6))
        unknowns = np.kron(nodes.toarray(), np.ones((2, 2)))
        for pattern in (nodes, unknowns, np.argwhere(unknowns), "dense"):
            system = chain.system(stiffness=None, pattern=pattern)
            self.assertLess(np.max(np.abs(solved(system) - expected)), 1e-9)

    def test_without_times_the_state_that_was_reached_is_returned(self):
        system = qddot.System([1.0], problems.duffing_force, problems.duffing_potential)
        failed = qddot.solve(system, "verlet", step_size=10.0, q0=[1e3], until=1e3)
        self.assertEqual((failed.outcome, failed.q.shape), ("diverged", (1, 1)))
        self.assertEqual(failed.t[0], failed.t_reached)
        none = qddot.solve(system, "verlet", step_size=0.1, q0=[1.0], until=1.0, save_at=[])
        self.assertEqual((none.q.shape, len(none.energy.total)), ((0, 1), 0))
        times = np.arange(0, 0.31, 0.1)  # whose last is a rounding beyond 0.3
        self.assertGreater(times[-1], 0.3)
        seen = qddot.solve(system, "verlet", step_size=0.1, q0=[1.0], until=0.3, save_at=times)
        self.assertEqual(seen.t[-1], 0.3)

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

    def test_forces_that_vanish_at_the_start_are_looked_at_beside_it(self):
        def power(n, factor=1.0):
            def force(q, f):
                f[:] = -factor * q ** (n - 1)

            return qddot.System([1.0, 1.0], force, lambda q: np.sum(q**n) / n)

        run = dict(step_size=1e-3, until=0.01)
        for n in (2, 4, 6):
            for start in (np.zeros(2), np.array([1e-7, 0.0]), np.array([1.0, -2.0])):
                qddot.solve(power(n), "verlet", q0=start, **run).or_raise()
                with self.assertRaisesRegex(ValueError, "potential: .*f is -dV/dq"):
                    qddot.solve(power(n, 2.0), "verlet", q0=start, **run)

    def test_a_force_without_a_potential_is_a_gradient(self):
        def turning(rate, **check):
            def force(q, f):
                f[:] = -q + rate * np.array([-q[1], q[0], 0.0])

            return qddot.System(np.ones(3), force, **check)

        run = dict(step_size=1e-3, until=0.01, q0=np.array([1.0, 0.5, -2.0]))
        qddot.solve(turning(0.0), "verlet", **run).or_raise()
        for rate in (1e-2, -1.0, 100.0):
            with self.assertRaisesRegex(ValueError, "force: it is no gradient of a potential"):
                qddot.solve(turning(rate), "verlet", **run)
            qddot.solve(turning(rate, check=False), "verlet", **run).or_raise()
        # Networks of all kinds pass, also where their forces are large or vanish.
        for scale in (1e-8, 1.0, 1e8):
            chain = problems.Chain(5)
            q0, v0 = chain.start()

            def force(q, f, chain=chain, scale=scale):
                chain.force(q, f)
                f *= scale

            system = qddot.System(np.full(5, scale), force, dimension=2)
            qddot.solve(system, "verlet", q0=q0, v0=v0, step_size=1e-3, until=0.01).or_raise()

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
        run = dict(until=1.0, reference=a, **start)
        order = qddot.convergence(system, "blanes_moan4", 0.02, 5, **run).order
        # The last errors are within 20 times of what the reference certifies.
        self.assertLess(np.max(np.abs(order[np.isfinite(order)] - 4)), 0.1)
        self.assertGreater(np.count_nonzero(np.isfinite(order)), 2)

    def test_a_run_that_grows_warns(self):
        with self.assertWarnsRegex(Warning, "energy"):
            qddot.solve(qddot.scenes.oscillator(), "explicit_euler", step_size=0.003, until=9)
