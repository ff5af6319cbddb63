"""Checks that wrong arguments are refused in one sentence that says what is allowed, and that
allowed ones have their meaning."""

import os
import tempfile
import unittest
from unittest import mock

import numpy as np

import problems
import qddot

CLOTH = qddot.scenes.cloth(nodes=4)
MOVE = dict(positions=[[0.0], [1.0]], springs=[[0, 1]], stiffness=1.0, mass=1.0)


def scene(**changes):
    return qddot.Scene(**{**MOVE, **changes})


def system(**changes):
    return qddot.System(**{"mass": [1.0, 1.0], "force": problems.duffing_force, **changes})


REFUSALS = {
    "positions.*numbers": lambda: scene(positions=[["a"], ["b"]]),
    r"positions: .*\(nodes, dimension\)": lambda: scene(positions=[0.0, 1.0]),
    "positions: 4 columns; allowed are 1, 2 or 3": lambda: scene(positions=np.zeros((2, 4))),
    "springs: .*whole": lambda: scene(springs=[[0.5, 1]]),
    r"springs: .*\(springs, 2\)": lambda: scene(springs=[0, 1]),
    r"springs: node -1 is none": lambda: scene(springs=[[-1, 0]]),
    "node 7": lambda: scene(springs=[[0, 7]]),
    "pinned.*node 5": lambda: scene(pinned=[5]),
    "mass: 3 entries; allowed are 1 or 2": lambda: scene(mass=[1, 1, 1]),
    r"stiffness: -1 is not allowed": lambda: scene(stiffness=-1.0),
    "mass.*nan": lambda: scene(mass=np.nan),
    "velocities": lambda: scene(velocities=[[1.0]]),
    "gravity": lambda: scene(gravity=[1.0, 2.0]),
    "until": lambda: scene(until=-1.0),
    "replace: weight is none of": lambda: scene().replace(weight=1),
    "nowhere.toml": lambda: qddot.Scene.load("nowhere.toml"),
    "colour": lambda: qddot.Scene.from_toml('colour = 1\n[generator]\nkind = "cloth"\n'),
    "nowhere.obj": lambda: qddot.Scene.from_mesh("nowhere.obj", stiffness=1, node_mass=1),
    "nodes = 1 is not allowed": lambda: qddot.scenes.cloth(nodes=1),
    "size is not a parameter": lambda: qddot.scenes.cloth(size=3),
    "'verlt' is no method; there are .*verlet": lambda: qddot.solve(CLOTH, "verlt", step_size=1),
    "one of both": lambda: qddot.solve(CLOTH),
    "one of both.*": lambda: qddot.solve(CLOTH, "verlet", accuracy=1e-3),
    "step_size is missing; verlet": lambda: qddot.solve(CLOTH, "verlet"),
    "rtol is not for verlet": lambda: qddot.solve(CLOTH, "verlet", step_size=1e-3, rtol=1),
    "atol is not for verlet": lambda: qddot.solve(CLOTH, "verlet", step_size=1e-3, atol=1),
    "step_size is not for ida": lambda: qddot.solve(CLOTH, "ida", rtol=1e-3, step_size=1),
    "max_order is not for verlet; it is for .*cvode_bdf": lambda: qddot.solve(
        CLOTH, "verlet", step_size=1e-3, max_order=2
    ),
    "step_size = -1 is not allowed": lambda: qddot.solve(CLOTH, "verlet", step_size=-1),
    "step_size = nan": lambda: qddot.solve(CLOTH, "verlet", step_size=np.nan),
    "rtol = 1e-20": lambda: qddot.solve(CLOTH, "ida", rtol=1e-20),
    "spectral_radius = 2": lambda: qddot.solve(
        CLOTH, "generalized_alpha", step_size=1e-3, spectral_radius=2
    ),
    "solver: best is none; allowed are .*multifrontal": lambda: qddot.solve(
        CLOTH, "implicit_euler", step_size=1e-3, solver="best"
    ),
    "until 0 is not allowed": lambda: qddot.solve(CLOTH, "verlet", step_size=1e-3, until=0),
    "until is missing": lambda: qddot.solve(scene(), "verlet", step_size=1e-3),
    "save_at: .* ascend from 0 to until = 0.1 s": lambda: qddot.solve(
        CLOTH, "verlet", step_size=1e-3, until=0.1, save_at=[0.05, 0.2]
    ),
    "save_at: its times": lambda: qddot.solve(
        CLOTH, "verlet", step_size=1e-3, until=0.1, save_at=[0.05, 0.01]
    ),
    "save_at: its times.*": lambda: qddot.solve(
        CLOTH, "verlet", step_size=1e-3, until=0.1, save_at=[np.nan]
    ),
    "threads 0": lambda: qddot.solve(CLOTH, "verlet", step_size=1e-3, threads=0),
    "seconds -1": lambda: qddot.solve(CLOTH, "verlet", step_size=1e-3, seconds=-1),
    "keep: half is no reduction; allowed are pins": lambda: qddot.solve(
        CLOTH, "verlet", step_size=1e-3, keep=["half"]
    ),
    "accuracy": lambda: qddot.solve(CLOTH, accuracy=2),
    "step_size is not for accuracy": lambda: qddot.solve(CLOTH, accuracy=1e-3, step_size=1),
    "accuracy_of: all; allowed are positions": lambda: qddot.solve(
        CLOTH, accuracy=1e-3, accuracy_of="all"
    ),
    "names no stiff springs": lambda: qddot.solve(CLOTH, "arkode_mri3", step_size=1e-3),
    "exact: .*K changes": lambda: qddot.solve(CLOTH, "exact", step_size=1e-3),
    "q0 is missing": lambda: qddot.solve(system(), "verlet", step_size=1, until=1),
    r"q0: its shape is \(3,\)": lambda: qddot.solve(
        system(), "verlet", step_size=1, until=1, q0=[1, 2, 3]
    ),
    "v0: its shape": lambda: qddot.solve(
        system(), "verlet", step_size=1, until=1, q0=[1, 2], v0=[[1, 2]]
    ),
    "keep: it is for scenes": lambda: qddot.solve(
        system(), "verlet", step_size=1, until=1, q0=[1, 2], keep=["pins"]
    ),
    "force: it is neither a callable nor a C": lambda: system(force=5),
    "dimension 4": lambda: system(dimension=4),
    r"mass: its shape is \(2, 3\)": lambda: system(mass=np.ones((2, 3)), dimension=2),
    "mass: allowed are": lambda: system(mass=[1.0, -1.0]),
    "mass: allowed are finite": lambda: system(mass=[]),
    "length 0": lambda: system(length=0),
    "pattern: its shape is": lambda: system(pattern=np.eye(3)),
    "pattern 'sparse'": lambda: system(pattern="sparse"),
    r"pattern: entry \(9, 0\)": lambda: qddot.solve(
        system(pattern=[[9, 0]]), "verlet", step_size=1, until=1, q0=[1, 2]
    ),
    "mass: .* masked": lambda: scene(mass=np.ma.array([1.0, 1.0], mask=[0, 1])),
    "positions: .* real numbers": lambda: scene(positions=np.array([[0j], [1.0]])),
    "mass: .* real numbers": lambda: scene(mass=np.array([True, False])),
    "velocities: their shape is .2, 1. *|velocities: their shape": lambda: scene(
        velocities=[[1.0, 2.0]]
    ),
    r"pinned: the mask's shape is \(3,\)": lambda: scene(pinned=[True, False, True]),
    "pinned: allowed are .* each once": lambda: scene(pinned=[0, 0]),
    "until: 'late' is no number": lambda: qddot.solve(CLOTH, "verlet", step_size=1, until="late"),
    "step_size: 'x' is no number": lambda: qddot.solve(CLOTH, "verlet", step_size="x"),
    "rtol: None|rtol is missing": lambda: qddot.solve(CLOTH, "ida", rtol=None),
    "max_order: 2.5 is no whole number": lambda: qddot.solve(
        CLOTH, "cvode_bdf", rtol=1e-3, max_order=2.5
    ),
    "compensated: 1 is neither": lambda: qddot.solve(
        CLOTH, "verlet", step_size=1e-3, compensated=1
    ),
    "threads: 2.5": lambda: qddot.solve(CLOTH, "verlet", step_size=1e-3, threads=2.5),
    "threads 100000 .* from 1 to 256": lambda: qddot.solve(
        CLOTH, "verlet", step_size=1e-3, threads=100000
    ),
    "accuracy_of: None": lambda: qddot.solve(CLOTH, accuracy=1e-3, accuracy_of=None),
    "seconds nan": lambda: qddot.solve(CLOTH, "verlet", step_size=1e-3, seconds=np.nan),
    "repeats 0": lambda: qddot.work_precision(CLOTH, 0.01, ["verlet"], repeats=0),
    "point_limit -1": lambda: qddot.work_precision(CLOTH, 0.01, ["verlet"], point_limit=-1),
    "q0: some of its entries are not finite": lambda: qddot.solve(
        system(), "verlet", step_size=1, until=1, q0=[1, np.nan]
    ),
    r"pattern: it is no matrix .* \(0,\)": lambda: system(pattern=[]),
    "pattern: it has entries that are no whole": lambda: system(pattern=[[0.5, 0], [1, 1], [0, 1]]),
    "implicit_euler needs K: .*pattern": lambda: qddot.solve(
        system(), "implicit_euler", step_size=1, until=1, q0=[1, 2]
    ),
    "discrete_gradient needs the discrete gradient": lambda: qddot.solve(
        system(), "discrete_gradient", step_size=1, until=1, q0=[1, 2]
    ),
    "foo is not for verlet": lambda: qddot.linear_step("verlet", 1.0, foo=1),
    "equilibrium: the System has no V": lambda: qddot.equilibrium(system(pattern="dense"), [1, 2]),
    "modes: the System has no K": lambda: qddot.modes(system(), 1, [1, 2]),
    "every 0": lambda: qddot.exchange(qddot.scenes.fpu(), ["verlet"], until=1, every=0),
    "reference: it is that of another": lambda: qddot.convergence(
        qddot.scenes.cloth(nodes=5), "verlet", 1e-3, reference=qddot.reference(CLOTH, 0.01)
    ),
    "reference: some unknowns have no mass": lambda: qddot.reference(
        qddot.Scene(
            [[0.0, 0.0], [1.0, 0.0], [2.0, 0.1]],
            [[0, 1], [1, 2]],
            stiffness=10.0,
            mass=[1.0, 0.0, 1.0],
            pinned=[0],
        ).replace(rest_length=0.5, quartic=[0.0, 1.0]),
        1.0,
    ),
    "count 0": lambda: qddot.modes(CLOTH, 0),
    "'rk5' is no method": lambda: qddot.linear_step("rk5", 0.1),
    "chooses its steps": lambda: qddot.stability_limit("ida"),
    "methods: 'verlet' is one word": lambda: qddot.work_precision(CLOTH, 0.1, "verlet"),
    "accuracy 2": lambda: qddot.advise(CLOTH, 2, until=0.1),
    "stiff_above: it is missing": lambda: qddot.exchange(CLOTH, ["verlet"], until=0.1),
    "ida chooses its steps": lambda: qddot.exchange(qddot.scenes.fpu(), ["ida"], until=1),
    "h_omega": lambda: qddot.exchange(qddot.scenes.fpu(), ["verlet"], [-1], until=1),
}


class Refusals(unittest.TestCase):
    def test_each_in_a_sentence(self):
        for sentence, call in REFUSALS.items():
            with self.subTest(sentence):
                with self.assertRaisesRegex(ValueError, sentence) as raised:
                    call()
                self.assertNotIn("\n", str(raised.exception))
                self.assertLess(len(str(raised.exception)), 1200)

    def test_what_is_wrong_alone_beside_the_start(self):
        q0 = [0.0, 0.0]
        for force in (lambda q, f: np.copyto(f, -2 * q), lambda q, f: np.copyto(f, q)):
            bad = system(force=force, potential=lambda q: q @ q / 2)
            with self.assertRaisesRegex(ValueError, "potential: beside the start"):
                qddot.solve(bad, "verlet", step_size=0.1, until=1, q0=q0)

        def unwritten(q, f):
            f = -q  # noqa: F841, which is the mistake

        with self.assertRaisesRegex(ValueError, r"force: f\[0\] is nan .*is it written there"):
            qddot.solve(system(force=unwritten), "rk4", step_size=0.1, until=1, q0=q0)
        nan = system(potential=lambda q: np.nan)
        with self.assertRaisesRegex(ValueError, "potential: beside"):
            qddot.solve(nan, "verlet", step_size=0.1, until=1, q0=q0)
        chain = problems.Chain(4)
        with self.assertRaisesRegex(ValueError, "pattern: .* lacks entries"):
            start = chain.start()[0]
            qddot.modes(chain.system(stiffness=None, pattern=np.eye(4)), 2, start)
        one_of_many = np.ones(100)
        one_of_many[37] = 1.5
        wrong = qddot.System(
            np.ones(100), lambda q, f: np.copyto(f, -one_of_many * q), lambda q: q @ q / 2
        )
        with self.assertRaisesRegex(ValueError, "potential: beside"):
            qddot.solve(wrong, "verlet", step_size=0.1, until=1, q0=np.ones(100))
        # A kink at the start itself is nobody's mistake.
        contact = qddot.System(
            [1.0], lambda q, f: np.copyto(f, np.where(q < 0, -1e3 * q, 0.0) - 1.0),
            lambda q: float(np.where(q < 0, 500 * q**2, 0.0).sum() + q.sum()),
        )  # fmt: skip
        qddot.solve(contact, "verlet", step_size=1e-3, until=0.1, q0=[0.0]).or_raise()

    def test_other_things_are_type_errors(self):
        with self.assertRaisesRegex(TypeError, "neither a qddot.Scene nor a qddot.System"):
            qddot.solve("cloth", "verlet", step_size=1e-3, until=1)
        with self.assertRaises(TypeError):
            qddot.energy_trend(system(), "verlet", step_size=1e-3, until=1)
        with self.assertRaises(AttributeError):
            qddot.scenes.carpet


class Meaning(unittest.TestCase):
    def test_a_scene_is_its_arrays(self):
        given = problems.random_scene(7)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "given.toml")
            given.save(path)
            read = qddot.Scene.load(path)
        for name in (
            "positions",
            "velocities",
            "mass",
            "pinned",
            "springs",
            "stiffness",
            "rest_length",
        ):
            self.assertTrue(np.array_equal(getattr(given, name), getattr(read, name)), name)
            with self.assertRaises(ValueError):
                getattr(given, name)[0] = 0
        self.assertEqual(given.content_hash(), read.content_hash())
        moved = given.replace(positions=given.positions + 1.0)
        self.assertTrue(np.array_equal(moved.rest_length, given.rest_length))
        self.assertNotEqual(moved.content_hash(), given.content_hash())
        mask = np.arange(8) == 0
        self.assertEqual(given.replace(pinned=mask).content_hash(), given.content_hash())

    def test_forces_are_the_gradient_of_the_energy(self):
        model = problems.random_scene(9).model()
        u = np.random.default_rng(1).standard_normal(model.size)
        d = 1e-6

        def plain_k():
            data, rows, first = model.stiffness(model.q)
            columns = np.repeat(np.arange(model.size), np.diff(first))
            k = np.zeros((model.size, model.size))
            k[rows, columns] = data
            return k + np.tril(k, -1).T

        ahead, behind = model.q + d * u, model.q - d * u
        slope = (model.potential(ahead) - model.potential(behind)) / (2 * d)
        # Differences of second order: d^2 of the third derivative, and rounding over d.
        self.assertAlmostEqual(slope, -model.force(model.q) @ u, delta=1e-6 * abs(slope))
        change = (model.force(ahead) - model.force(behind)) / (2 * d)
        self.assertLess(np.max(np.abs(change - plain_k() @ u)), 1e-6 * np.max(np.abs(change)))

    def test_a_mesh(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'a "mesh".obj')
            with open(path, "w", encoding="utf-8") as file:
                file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
            mesh = qddot.Scene.from_mesh(
                path, stiffness=10, total_mass=4, scale=2, gravity=[0, 0, -9.81], until=1,
                pins=[([-1, -1, -1], [0.1, 0.1, 0.1])],
            )  # fmt: skip
        self.assertEqual((len(mesh.mass), len(mesh.stiffness)), (4, 5))
        self.assertEqual(list(mesh.pinned), [True, False, False, False])
        self.assertTrue(np.array_equal(mesh.positions[1], [2, 0, 0]))
        self.assertEqual(mesh.until, 1)

    def test_explanations(self):
        chain = problems.Chain(3).scene()
        explained = chain.explain()
        self.assertEqual(explained.unknowns, 6)
        # Springs of 100 N/m between three nodes of 1 kg: w = 2 sqrt(100) sin(3 pi / 8).
        omega = 20 * np.sin(3 * np.pi / 8)
        self.assertAlmostEqual(explained.omega_max, omega, delta=2e-4 * omega)
        self.assertAlmostEqual(explained.largest_stable_step, 2 / omega, delta=1e-4)
        self.assertIn("pins", str(explained))
        self.assertIn(("pins"), [name for name, _ in explained.left_out])
        self.assertGreater(chain.explain(keep=["pins"]).unknowns, 6)

    def test_methods_say_what_they_are(self):
        all_of_them = qddot.methods()
        self.assertGreater(len(all_of_them), 50)
        verlet = qddot.method("verlet")
        self.assertEqual((verlet.order, verlet.knob, verlet.stability_limit), (2, "step_size", 2.0))
        self.assertIn("symplectic", verlet.traits)
        step = qddot.linear_step("verlet", 1.0)
        # q_{n+1} - (2 - (h w)^2) q_n + q_{n-1} = 0.
        self.assertAlmostEqual(step.spectral_radius, 1, delta=1e-12)
        self.assertAlmostEqual(abs(np.angle(step.roots[0])), np.arccos(0.5), delta=1e-12)
        limit = qddot.stability_limit("verlet")
        self.assertAlmostEqual(limit.measured, limit.predicted, delta=1e-9)

    def test_failures_are_solutions(self):
        failed = qddot.solve(
            CLOTH, "verlet", step_size=0.05, until=10, save_at=np.linspace(0, 10, 11)
        )
        self.assertFalse(failed.success)
        self.assertEqual(failed.outcome, "diverged")
        self.assertTrue(failed.message)
        self.assertEqual(len(failed.t), len(failed.q))
        self.assertLess(len(failed.t), 11)
        self.assertTrue(np.all(np.isfinite(failed.end.q)))
        with self.assertRaisesRegex(qddot.RunFailed, "smaller step") as raised:
            failed.or_raise()
        self.assertIs(raised.exception.solution, failed)
        stopped = qddot.solve(CLOTH, "verlet", step_size=1e-7, until=1e3, seconds=0.1)
        self.assertEqual(stopped.outcome, "over_budget")

    def test_options_are_spelled_as_here(self):
        stiff = qddot.solve(CLOTH, "verlet", step_size=0.05, until=10)
        early = qddot.solve(qddot.scenes.cloth(nodes=8), accuracy=1e-6, until=30)
        buckled = qddot.scenes.strut().explain()
        for words in (stiff.message, stiff.diagnosis(), early.message, str(buckled)):
            self.assertNotIn("--", words)
        self.assertIn("accuracy_of", early.message)
        self.assertIn("keep=dimension,mirror", str(buckled))
        with self.assertRaisesRegex(qddot.NoReference, r"\(until\)"):
            qddot.reference(qddot.scenes.lattice(), 1e4, seconds=0.1)

    def test_answers_that_cannot_be_had_are_solutions(self):
        chaotic = qddot.solve(qddot.scenes.cloth(nodes=8), accuracy=1e-6, until=30)
        self.assertFalse(chaotic.success)
        with self.assertRaises(qddot.RunFailed):
            chaotic.or_raise()
        self.assertTrue(chaotic.message)

    def test_the_best_run_of_a_chaotic_motion_is_that_motion(self):
        # One step of local_global keeps the energy well, in other modes.
        chain = qddot.scenes.chain(nodes=4, stiffness=1000)
        methods = ["local_global", "blanes_moan6"]
        chart = qddot.work_precision(chain, 12, methods, point_limit=0.2, repeats=1)
        self.assertTrue(chart.reference.beyond_horizon)
        coarse = chart.points[chart.points["method"] == "local_global"][0]
        self.assertLess(coarse["error_energy_max"], 0.5)
        self.assertEqual(chart.best(0.5).method, "blanes_moan6")
        self.assertEqual(chart.best(1e-3).method, "blanes_moan6")
        self.assertEqual(chart.record["judged_by"], "energy")

    def test_a_chart_is_its_points(self):
        chart = qddot.work_precision(CLOTH, 0.1, ["verlet", "implicit_midpoint"], point_limit=0.05)
        self.assertEqual(set(chart.points["method"]), {"verlet", "implicit_midpoint"})
        for row in chart.front:
            best = chart.best(row["accuracy"])
            if row["method"]:
                self.assertEqual((best.method, best.value), (row["method"], row["value"]))
            else:
                self.assertIsNone(best)
        self.assertIsNone(chart.best(1e-30))
        seen = []
        qddot.work_precision(CLOTH, 0.1, ["verlet"], point_limit=0.05, progress=seen.append)
        self.assertTrue(all(point.method == "verlet" for point in seen) and len(seen) > 5)
        with tempfile.TemporaryDirectory() as folder:
            chart.save(folder)
            self.assertEqual(
                sorted(os.listdir(folder)),
                ["chart.json", "front.csv", "points.csv", "reference.json"],
            )
            table = problems.read_table(os.path.join(folder, "points.csv"))
            self.assertTrue(np.array_equal(table["time_s"], chart.points["time_s"], equal_nan=True))
            chart.draw(os.path.join(folder, "chart.svg"))
            with self.assertRaisesRegex(ValueError, "png"):
                chart.draw(os.path.join(folder, "chart.pdf"))
        self.assertEqual(chart._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertIsNone(chart._repr_html_())  # which a notebook would show instead
        with mock.patch.object(qddot.WorkPrecision, "_repr_png_", lambda self: None):
            self.assertIn("<table>", chart._repr_html_())
        self.assertIn("2 methods", repr(chart))

    def test_advice(self):
        advices = qddot.advise(CLOTH, [1e-2, 1e-6], until=0.1)
        self.assertEqual([advice.accuracy for advice in advices.for_each], [1e-2, 1e-6])
        take = advices.for_each[1].take
        run = qddot.solve(CLOTH, take.method, until=0.1, **{take.knob: take.value})
        self.assertLess(qddot.reference(CLOTH, 0.1).errors(run).position, 1e-6)
        self.assertIn("<table>", advices._repr_html_())
        self.assertIn(take.method, repr(advices))

    def test_references_judge_what_others_computed(self):
        chain = problems.Chain(3)
        scene = chain.scene()
        exact = qddot.reference(scene, 0.3)
        q, v = exact.q.copy(), exact.v
        self.assertEqual(exact.errors(q, v).position, 0)
        q[2, 1] += 1e-3
        # Over the largest displacement of the motion, which the reference says.
        scale = float(exact.divided_by.split("node, ")[1].split(" m")[0])
        self.assertAlmostEqual(exact.errors(q, v).position, 1e-3 / scale, delta=1e-2 * 1e-3 / scale)
        with self.assertRaisesRegex(ValueError, r"errors: q has the shape \(3, 2\)"):
            exact.errors(q[:3], v)
        with self.assertRaisesRegex(ValueError, "ends at t = 0.2"):
            exact.errors(qddot.solve(scene, "verlet", step_size=1e-3, until=0.2))


if __name__ == "__main__":
    unittest.main()
