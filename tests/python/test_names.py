"""Misspelt arguments, callables of other arguments, missing packages and names of systems."""

import sys
import unittest
from unittest import mock

import numpy as np

import problems
import qddot
from programs import Programs

CLOTH = qddot.scenes.cloth(nodes=4)
MOVE = dict(positions=[[0.0], [1.0]], springs=[[0, 1]], stiffness=1.0, mass=1.0)


class Names(unittest.TestCase):
    def test_a_misspelt_argument_is_refused_with_the_nearest(self):
        run, force = dict(until=0.1), problems.duffing_force
        for call, wrong, right in (
            (lambda **x: qddot.solve(CLOTH, "verlet", **run, **x), "dt", "step_size"),
            (lambda **x: qddot.solve(CLOTH, "verlet", **run, **x), "h", "step_size"),
            (lambda **x: qddot.solve(CLOTH, "verlet", **run, **x), "stepsize", "step_size"),
            (lambda **x: qddot.solve(CLOTH, "verlet", **run, **x), "t_eval", "save_at"),
            (lambda **x: qddot.solve(CLOTH, "ida", **run, **x), "tol", "rtol"),
            (lambda **x: qddot.solve(CLOTH, "ida", **x), "t_end", "until"),
            (lambda **x: qddot.advise(CLOTH, 1e-3, **x), "untill", "until"),
            (lambda **x: qddot.reference(CLOTH, **x), "second", "seconds"),
            (lambda **x: qddot.work_precision(CLOTH, **x), "method", "methods"),
            (lambda **x: qddot.convergence(CLOTH, "verlet", **x), "dt", "step_size"),
            (lambda **x: qddot.exchange(CLOTH, ["verlet"], **x), "homega", "h_omega"),
            (lambda **x: qddot.modes(CLOTH, **x), "counts", "count"),
            (lambda **x: qddot.equilibrium(CLOTH, **x), "x0", "q0"),
            (lambda **x: qddot.stability_limit("verlet", **x), "q", "q0"),
            (lambda **x: qddot.Scene(**MOVE, **x), "velocity", "velocities"),
            (lambda **x: qddot.Scene(**MOVE, **x), "fixed", "pinned"),
            (lambda **x: qddot.Scene.from_mesh("a.obj", **x), "stifness", "stiffness"),
            (lambda **x: qddot.System([1.0], force, **x), "jac", "stiffness"),
        ):
            with self.subTest(wrong=wrong, right=right):
                sentence = rf"^{wrong} is no argument of .*, the nearest is {right};"
                with self.assertRaisesRegex(TypeError, sentence):
                    call(**{wrong: 1e-3})
        with self.assertRaisesRegex(TypeError, "^solve: 0.1 has no name; .* are until, step_size, "):
            qddot.solve(CLOTH, "verlet", 0.1)
        with self.assertRaisesRegex(AttributeError, "no generator of scenes, the nearest is cloth"):
            qddot.scenes.clot
        with self.assertRaisesRegex(TypeError, "^colour is no argument of solve; there are of, "):
            qddot.solve(CLOTH, colour=1)
        trend = qddot.energy_trend
        for call, sentence in (
            (lambda: trend(CLOTH, "verlet", dt=1e-3), "dt is not .* nearest is step_size"),
            (lambda: trend(CLOTH, "ida", rtol=1e-3, end=1), "end is not .* nearest is until"),
            (lambda: qddot.linear_step("bdf2", 1.0, solve_tol=3), "nearest is solve_tolerance"),
            (lambda: CLOTH.replace(velocity=0), "velocity is none of .* the nearest is velocities"),
            (lambda: qddot.scenes.cloth(node=5), "a parameter of cloth, the nearest is nodes;"),
            (lambda: qddot.method("Verlet"), "the nearest is verlet"),
        ):
            with self.assertRaisesRegex(ValueError, sentence):
                call()

    def test_signatures_and_warnings_stay_those_of_the_functions(self):
        import inspect

        self.assertIn("step_size", inspect.signature(qddot.solve).parameters)
        self.assertIn("dimension", inspect.signature(qddot.System).parameters)
        with self.assertWarns(RuntimeWarning) as warned:
            qddot.solve(qddot.scenes.oscillator(), "explicit_euler", step_size=0.003, until=9)
        self.assertEqual(warned.filename, __file__)

    def test_solve_has_every_option_of_the_table(self):
        import inspect

        rows = [row for row in qddot._qddot.options() if row["takers"] != "all"]
        for row in rows:
            self.assertIn(row["name"], inspect.signature(qddot.solve).parameters)
            if row["takers"] == "takes":
                self.assertIn(f"{row['name']}: {row['words']}.", qddot.solve.__doc__)
        taken = {name for method in qddot.methods() for name in method.takes}
        self.assertEqual(taken, {row["name"] for row in rows if row["takers"] == "takes"})

    def test_callables_of_other_arguments(self):
        for call, sentence in (
            (lambda: qddot.System([1.0], lambda: None), r"force: it takes \(\); .*force\(q, f\)"),
            (
                lambda: qddot.System([1.0], problems.duffing_force, lambda: 0.0),
                r"potential: it takes \(\); it is called as potential\(q\)",
            ),
            (
                lambda: qddot.System([1.0], problems.duffing_force, stiffness=lambda q, f: 0.0),
                r"stiffness: it takes \(q, f\); it is called as stiffness\(q\)",
            ),
            (
                lambda: qddot.work_precision(CLOTH, 0.1, ["verlet"], progress=lambda: None),
                r"progress: it takes \(\); it is called as progress\(point\)",
            ),
        ):
            with self.assertRaisesRegex(ValueError, sentence):
                call()


class Packages(Programs):
    def test_a_missing_package_is_named(self):
        chart = qddot.work_precision(CLOTH, 0.05, ["verlet"], point_limit=0.02, repeats=1)
        with mock.patch.dict(sys.modules, {"matplotlib": None, "scipy": None}):
            for call, package in (
                (lambda: chart.draw("chart.png"), "matplotlib"),
                (CLOTH.stiffness_matrix, "scipy"),
            ):
                sentence = f"{package}, which is not installed; .*python3-{package}, .* {package}$"
                with self.assertRaisesRegex(ImportError, sentence):
                    call()
            self.assertIsNone(chart._repr_png_())
            self.assertIn("<table>", chart._repr_html_())


class Systems(Programs):
    def test_a_name_appears_wherever_the_system_does(self):
        forces = problems.duffing_force, problems.duffing_potential, problems.duffing_stiffness
        duffing = qddot.System([1.0], *forces, name="duffing")
        shown = "<qddot.System 'duffing': 1 unknowns; force, potential, stiffness>"
        self.assertEqual(repr(duffing), shown)
        self.assertEqual(qddot.System([1.0], forces[0]).name, "system")
        run = dict(q0=[1.0], point_limit=0.02, repeats=1)
        chart = qddot.work_precision(duffing, 0.5, ["verlet"], **run)
        self.assertIn("'duffing'", repr(chart))
        self.assertIn("'duffing'", repr(chart.reference))
        self.assertEqual(set(chart.points["scene"]), {"duffing"})
        chart.save(".")
        for file in ("points.csv", "chart.json", "reference.json"):
            with open(file, encoding="utf-8") as text:
                self.assertIn("duffing", text.read(), file)
        bare = qddot.System([1.0], forces[0], name="bare")
        with self.assertRaisesRegex(ValueError, "reference: .* give 'bare' a potential"):
            qddot.reference(bare, 1.0, q0=[1.0])
        with self.assertRaisesRegex(ValueError, "name: 5 is no name"):
            qddot.System([1.0], forces[0], name=5)


    def test_an_equilibrium_that_is_far_away_asks_for_a_length(self):
        def pulled(**length):
            potential = lambda q: float(((q - 5e6) ** 2).sum() / 2)
            return qddot.System(
                [1.0], lambda q, f: np.copyto(f, 5e6 - q), potential, [[-1.0]], **length
            )

        lost = qddot.equilibrium(pulled(), [0.0])
        self.assertEqual(lost.outcome, "unbounded")
        self.assertIn("(length = 1 m)", lost.message)
        for of, given in ((pulled(), dict(length=1e3)), (pulled(length=1e3), {})):
            found = qddot.equilibrium(of, [0.0], **given)
            self.assertEqual(found.outcome, "reached")
            self.assertAlmostEqual(found.positions[0], 5e6, delta=1e-6)
        with self.assertRaisesRegex(ValueError, "length 0 is not allowed"):
            qddot.equilibrium(pulled(), [0.0], length=0)


class Matrices(unittest.TestCase):
    @problems.needs_scipy
    def test_forces_of_a_scene_are_the_gradient_of_its_energy(self):
        for dimension in (1, 2, 3):
            scene = problems.random_scene(4, dimension).replace(quartic=50.0)
            # Far from the origin, where reductions move it.
            scene = scene.replace(positions=scene.positions + 3)
            n, d = scene.positions.size, 1e-5
            random = np.random.default_rng(dimension)
            q = scene.positions + 0.05 * random.standard_normal(scene.positions.shape)
            k = scene.stiffness_matrix(q)
            self.assertEqual((k.shape, k.format), ((n, n), "csc"))
            self.assertEqual(abs(k - k.T).max(), 0)
            free = ~np.repeat(scene.pinned, dimension)
            self.assertEqual(abs(k[np.flatnonzero(~free)]).max(), 0)
            u = random.standard_normal(n) * free
            ahead, behind = q.reshape(-1) + d * u, q.reshape(-1) - d * u
            # Differences of second order: d^2 of the third derivative, and rounding over d.
            slope = (scene.potential(ahead) - scene.potential(behind)) / (2 * d)
            f = scene.force(q)
            self.assertEqual(f.shape, q.shape)
            self.assertAlmostEqual(slope, -f.reshape(-1) @ u, delta=1e-6 * np.abs(f).max())
            change = (scene.force(ahead) - scene.force(behind)) / (2 * d)
            self.assertLess(np.max(np.abs(change - k @ u)), 1e-6 * np.abs(k @ u).max())
            # The same entries at every q.
            other = scene.stiffness_matrix()
            self.assertTrue(np.array_equal(other.indices, k.indices))
            self.assertTrue(np.array_equal(other.indptr, k.indptr))

    def test_they_are_those_of_the_motion(self):
        cloth = qddot.scenes.cloth(nodes=4)
        sol = qddot.solve(cloth, "verlet", step_size=1e-3, until=0.3, save_at=[0.0, 0.3])
        for k in (0, 1):
            v = cloth.potential(sol.q[k])
            # Two orders of one sum; the constants agree, too.
            self.assertAlmostEqual(v, sol.energy.potential[k], delta=1e-12 * (1 + abs(v)))
        # The last acceleration, by a step that is so short that Verlet's is h f / m.
        h = 1e-6
        start = cloth.replace(positions=sol.q[1], velocities=sol.v[1], rest_length=cloth.rest_length)
        after = qddot.solve(start, "verlet", step_size=h, until=h).end
        f = cloth.force(sol.q[1])
        self.assertEqual(np.abs(f[cloth.pinned]).max(), 0)
        a = (after.v - sol.v[1]) / h
        self.assertLess(np.max(np.abs(a - f / cloth.mass[:, None])), 1e-3 * np.abs(a).max())

    @problems.needs_scipy
    def test_other_shapes_are_refused(self):
        for call in (CLOTH.force, CLOTH.potential, CLOTH.stiffness_matrix):
            sentence = r"q: its shape is \(3, 3\); allowed .* \(16, 3\) or \(48\)"
            with self.assertRaisesRegex(ValueError, sentence):
                call(np.zeros((3, 3)))


if __name__ == "__main__":
    unittest.main()
