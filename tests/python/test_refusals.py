"""Checks that wrong arguments are refused in one sentence that says what is allowed, and that
allowed ones have their meaning."""

import importlib.util
import os
import unittest
from unittest import mock

import numpy as np

import problems
import qddot
from problems import scipy
from programs import Programs, write

CLOTH = qddot.scenes.cloth(nodes=4)
MOVE = dict(positions=[[0.0], [1.0]], springs=[[0, 1]], stiffness=1.0, mass=1.0)
RUN = dict(method="verlet", step_size=1e-3)
IDA = dict(method="ida", rtol=1e-3, step_size=None)
ANSWER = dict(method=None, step_size=None, accuracy=1e-3)


def scene(**changes):
    return qddot.Scene(**{**MOVE, **changes})


def system(**changes):
    return qddot.System(**{"mass": [1.0, 1.0], "force": problems.duffing_force, **changes})


def solve(problem=CLOTH, **changes):
    return qddot.solve(problem, **{**RUN, **changes})


def solve_own(changes=None, **options):
    return solve(system(**(changes or {})), **{"step_size": 1, "until": 1, "q0": [1, 2]} | options)


# The sentences that refuse arguments of a call, and what is wrong in them.
OF_SCENES = {
    "positions.*numbers": dict(positions=[["a"], ["b"]]),
    r"positions: .*\(nodes, dimension\)": dict(positions=[0.0, 1.0]),
    "positions: 4 columns; allowed are 1, 2 or 3": dict(positions=np.zeros((2, 4))),
    "positions: .* real numbers": dict(positions=np.array([[0j], [1.0]])),
    "springs: .*whole": dict(springs=[[0.5, 1]]),
    r"springs: .*\(springs, 2\)": dict(springs=[0, 1]),
    r"springs: node -1 is none": dict(springs=[[-1, 0]]),
    "node 7": dict(springs=[[0, 7]]),
    "pinned.*node 5": dict(pinned=[5]),
    r"pinned: the mask's shape is \(3,\)": dict(pinned=[True, False, True]),
    "pinned: allowed are .* each once": dict(pinned=[0, 0]),
    "mass: 3 entries; allowed are 1 or 2": dict(mass=[1, 1, 1]),
    "mass.*nan": dict(mass=np.nan),
    "mass: .* masked": dict(mass=np.ma.array([1.0, 1.0], mask=[0, 1])),
    "mass: .* real numbers": dict(mass=np.array([True, False])),
    r"stiffness: -1 is not allowed": dict(stiffness=-1.0),
    "velocities: their shape": dict(velocities=[[1.0, 2.0]]),
    "load: their shape": dict(load=[[1.0, 2.0]]),
    "gravity": dict(gravity=[1.0, 2.0]),
    "until": dict(until=-1.0),
}
OF_RUNS = {
    "'verlt' is no method, the nearest is verlet; there are .*verlet": dict(method="verlt"),
    "one of both": dict(method=None, step_size=None),
    "one of both.*": dict(step_size=None, accuracy=1e-3),
    "step_size is missing; verlet": dict(step_size=None),
    "rtol is not for verlet": dict(rtol=1),
    "atol is not for verlet": dict(atol=1),
    "step_size is not for ida": IDA | dict(step_size=1),
    "max_order is not for verlet; it is for .*cvode_bdf": dict(max_order=2),
    "max_order: 2.5 is no whole number": IDA | dict(method="cvode_bdf", max_order=2.5),
    "step_size = -1 is not allowed": dict(step_size=-1),
    "step_size = nan": dict(step_size=np.nan),
    "step_size: 'x' is no number": dict(step_size="x"),
    "rtol = 1e-20": IDA | dict(rtol=1e-20),
    "rtol: None|rtol is missing": IDA | dict(rtol=None),
    "spectral_radius = 2": dict(method="generalized_alpha", spectral_radius=2),
    "solver: best is none; allowed are .*multifrontal": dict(
        method="implicit_euler", solver="best"
    ),
    "until 0 is not allowed": dict(until=0),
    "until: 'late' is no number": dict(until="late"),
    "until is missing": dict(problem=scene()),
    "save_at: .* ascend from 0 to until = 0.1 s": dict(until=0.1, save_at=[0.05, 0.2]),
    "save_at: its times": dict(until=0.1, save_at=[0.05, 0.01]),
    "save_at: its times.*": dict(until=0.1, save_at=[np.nan]),
    "threads 0": dict(threads=0),
    "threads: 2.5": dict(threads=2.5),
    "threads 100000 .* from 1 to 256": dict(threads=100000),
    "seconds -1": dict(seconds=-1),
    "seconds nan": dict(seconds=np.nan),
    "compensated: 1 is neither": dict(compensated=1),
    "keep: half is no reduction; allowed are pins": dict(keep=["half"]),
    "accuracy": ANSWER | dict(accuracy=2),
    "step_size is not for accuracy": ANSWER | dict(step_size=1),
    "accuracy_of: all; allowed are positions": ANSWER | dict(accuracy_of="all"),
    "names no stiff springs": dict(method="arkode_mri3"),
    "exact: .*K changes": dict(method="exact"),
    "q0 is for a System.*positions": dict(q0=[0]),
    "v0 is for a System.*velocities": dict(v0=[0]),
}
OF_SYSTEMS = {
    "force: it is neither a callable nor a C": dict(force=5),
    "stiffness: it is neither a callable nor a matrix": dict(stiffness=5),
    "dimension 4": dict(dimension=4),
    r"mass: its shape is \(2, 3\)": dict(mass=np.ones((2, 3)), dimension=2),
    "mass: allowed are": dict(mass=[1.0, -1.0]),
    "mass: allowed are finite": dict(mass=[]),
    "length 0": dict(length=0),
    "pattern: its shape is": dict(pattern=np.eye(3)),
    "pattern 'sparse'": dict(pattern="sparse"),
    r"pattern: it is no matrix .* \(0,\)": dict(pattern=[]),
    "pattern: it has entries that are no whole": dict(pattern=[[0.5, 0], [1, 1], [0, 1]]),
    r"force\(q, f\).*velocity": dict(force=lambda q, v, f: None),
    r"force: it takes \(q\); it is called as force\(q, f\) and writes f": dict(force=lambda q: -q),
    r"potential\(q\)": dict(potential=lambda q, v: 0.0),
    r"stiffness\(q\)": dict(stiffness=lambda t, q: 0.0),
}


def broken_matrix():
    """A sparse matrix whose columns begin at a negative number."""
    broken = scipy.sparse.csr_matrix(np.array([[-1.0, 0.5], [0.5, -1.0]]))
    broken.indptr[1] = -5
    broken.has_sorted_indices = broken.has_canonical_format = True
    return broken


OF_OWN_RUNS = {
    "q0 is missing": dict(q0=None),
    r"q0: its shape is \(3,\)": dict(q0=[1, 2, 3]),
    "q0: some of its entries are not finite": dict(q0=[1, np.nan]),
    "v0: its shape": dict(v0=[[1, 2]]),
    "keep: it is for scenes": dict(keep=["pins"]),
    r"pattern: entry \(9, 0\)": dict(changes=dict(pattern=[[9, 0]])),
    "implicit_euler needs K: .*pattern": dict(method="implicit_euler"),
    "discrete_gradient needs the discrete gradient": dict(method="discrete_gradient"),
    # Results of callables.
    "force: it returned something": dict(changes=dict(force=lambda q, f: -q)),
    "is it written": dict(changes=dict(force=lambda q, f: f.fill(np.nan))),
    "f is -dV/dq": dict(changes=dict(potential=lambda q: -problems.duffing_potential(q))),
    "stiffness.*the other sign": dict(
        changes=dict(stiffness=lambda q: -problems.duffing_stiffness(q))
    ),
    "stiffness: beside the start it is not df/dq": dict(
        changes=dict(stiffness=lambda q: 2 * problems.duffing_stiffness(q))
    ),
    "stiffness: .*allowed is 2 x 2": dict(changes=dict(stiffness=lambda q: np.eye(3))),
    **({} if scipy is None else {"indptr": dict(
        changes=dict(stiffness=lambda q: broken_matrix(), pattern="dense"), method="implicit_euler"
    )}),
    # Entries beyond the pattern of the first K.
    r"entry \(1, 0\).*pattern=": dict(
        changes=dict(
            stiffness=lambda q: np.array([[-1, q[0]], [q[0], -1]]), check=False, pattern=np.eye(2)
        ),
        method="implicit_euler",
    ),
}
MASSLESS = dict(positions=[[0.0, 0.0], [1.0, 0.0], [2.0, 0.1]], springs=[[0, 1], [1, 2]])
MASSLESS |= dict(stiffness=10.0, mass=[1.0, 0.0, 1.0], pinned=[0])
MASSLESS |= dict(rest_length=0.5, quartic=[0.0, 1.0])
FPU = qddot.scenes.fpu()
OF_OTHERS = {
    "replace: weight is none of": lambda: scene().replace(weight=1),
    "nowhere.toml": lambda: qddot.Scene.load("nowhere.toml"),
    "colour": lambda: qddot.Scene.from_toml('colour = 1\n[generator]\nkind = "cloth"\n'),
    "nowhere.obj": lambda: qddot.Scene.from_mesh("nowhere.obj", stiffness=1, node_mass=1),
    "nodes = 1 is not allowed": lambda: qddot.scenes.cloth(nodes=1),
    "size is not a parameter": lambda: qddot.scenes.cloth(size=3),
    "accuracy_of: None": lambda: qddot.solve(CLOTH, accuracy=1e-3, accuracy_of=None),
    "repeats 0": lambda: qddot.work_precision(CLOTH, 0.01, ["verlet"], repeats=0),
    "point_limit -1": lambda: qddot.work_precision(CLOTH, 0.01, ["verlet"], point_limit=-1),
    "methods: 'verlet' is one word": lambda: qddot.work_precision(CLOTH, 0.1, "verlet"),
    "foo is not for verlet": lambda: qddot.linear_step("verlet", 1.0, foo=1),
    "'rk5' is no method": lambda: qddot.linear_step("rk5", 0.1),
    "equilibrium: the System has no V": lambda: qddot.equilibrium(system(pattern="dense"), [1, 2]),
    "modes: the System has no K": lambda: qddot.modes(system(), 1, [1, 2]),
    "count 0": lambda: qddot.modes(CLOTH, 0),
    "every 0": lambda: qddot.exchange(FPU, ["verlet"], until=1, every=0),
    "ida chooses its steps": lambda: qddot.exchange(FPU, ["ida"], until=1),
    "h_omega": lambda: qddot.exchange(FPU, ["verlet"], [-1], until=1),
    "stiff_above: it is missing": lambda: qddot.exchange(CLOTH, ["verlet"], until=0.1),
    "chooses its steps": lambda: qddot.stability_limit("ida"),
    "accuracy 2": lambda: qddot.advise(CLOTH, 2, until=0.1),
    "reference: it is that of another": lambda: qddot.convergence(
        qddot.scenes.cloth(nodes=5), "verlet", 1e-3, reference=qddot.reference(CLOTH, 0.01)
    ),
    "reference: some unknowns have no mass": lambda: qddot.reference(qddot.Scene(**MASSLESS), 1.0),
}
TABLES = (
    (scene, OF_SCENES), (solve, OF_RUNS), (system, OF_SYSTEMS), (solve_own, OF_OWN_RUNS),
    (lambda call: call(), {sentence: {"call": call} for sentence, call in OF_OTHERS.items()}),
)  # fmt: skip


class Refusals(unittest.TestCase):
    def test_each_in_a_sentence(self):
        for call, table in TABLES:
            for sentence, arguments in table.items():
                with self.subTest(sentence):
                    with self.assertRaisesRegex(ValueError, sentence) as raised:
                        call(**arguments)
                    self.assertNotIn("\n", str(raised.exception))
                    self.assertLess(len(str(raised.exception)), 1200)

    def test_what_is_wrong_alone_beside_the_start(self):
        def unwritten(q, f):
            f = -q  # noqa: F841, which is the mistake

        one_of_many = np.ones(100)
        one_of_many[37] = 1.5
        half = dict(potential=lambda q: q @ q / 2)
        many = dict(mass=np.ones(100), force=lambda q, f: np.copyto(f, -one_of_many * q))
        for changes, q0, sentence in (
            (half | dict(force=lambda q, f: np.copyto(f, -2 * q)), [0.0, 0.0], "potential: beside"),
            (half | dict(force=lambda q, f: np.copyto(f, q)), [0.0, 0.0], "potential: beside"),
            (half | many, np.ones(100), "potential: beside"),
            (dict(potential=lambda q: np.nan), [0.0, 0.0], "potential: beside the start"),
            (dict(force=unwritten), [0.0, 0.0], r"force: f\[0\] is nan .*is it written there"),
        ):
            with self.assertRaisesRegex(ValueError, sentence):
                solve_own(changes, step_size=0.1, q0=q0)
        chain = problems.Chain(4)
        with self.assertRaisesRegex(ValueError, "pattern: .* lacks entries"):
            start = chain.start()[0]
            qddot.modes(chain.system(stiffness=None, pattern=np.eye(4)), 2, start)
        # A kink at the start itself is nobody's mistake.
        contact = qddot.System(
            [1.0], lambda q, f: np.copyto(f, np.where(q < 0, -1e3 * q, 0.0) - 1.0),
            lambda q: float(np.where(q < 0, 500 * q**2, 0.0).sum() + q.sum()),
        )  # fmt: skip
        qddot.solve(contact, "verlet", step_size=1e-3, until=0.1, q0=[0.0]).or_raise()

    def test_other_things_are_type_errors(self):
        run, start = dict(RUN, until=1), dict(q0=[1.0, 1.0], v0=[1.0, 1.0])
        for call, sentence in {
            lambda: qddot.solve("cloth", **run): "neither a qddot.Scene nor a qddot.System",
            lambda: qddot.energy_trend("cloth", **run): "neither a qddot.Scene nor a qddot.System",
            lambda: solve_own(dict(potential=lambda q: "much")): "",
            lambda: qddot.equilibrium(system(), **start): "",
            lambda: qddot.modes(system(), **start): "",
        }.items():
            self.assertRaisesRegex(TypeError, sentence, call)
        with self.assertRaises(AttributeError):
            qddot.scenes.carpet


class Meaning(Programs):
    def test_a_scene_is_its_arrays(self):
        given = problems.random_scene(7)
        given = given.replace(load=np.arange(24.0).reshape(8, 3) - 10)
        given.save("given.toml")
        read = qddot.Scene.load("given.toml")
        names = "positions velocities loads mass pinned springs stiffness rest_length".split()
        for name in names:
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
        data, rows, first = model.stiffness(model.q)
        k = np.zeros((model.size, model.size))
        k[rows, np.repeat(np.arange(model.size), np.diff(first))] = data
        k += np.tril(k, -1).T
        ahead, behind = model.q + d * u, model.q - d * u
        slope = (model.potential(ahead) - model.potential(behind)) / (2 * d)
        # Differences of second order: d^2 of the third derivative, and rounding over d.
        self.assertAlmostEqual(slope, -model.force(model.q) @ u, delta=1e-6 * abs(slope))
        change = (model.force(ahead) - model.force(behind)) / (2 * d)
        self.assertLess(np.max(np.abs(change - k @ u)), 1e-6 * np.max(np.abs(change)))

    def test_a_mesh(self):
        text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n"
        mesh = qddot.Scene.from_mesh(
            write('a "mesh".obj', text), stiffness=10, total_mass=4, scale=2,
            gravity=[0, 0, -9.81], until=1, pins=[([-1, -1, -1], [0.1, 0.1, 0.1])],
        )  # fmt: skip
        self.assertEqual((len(mesh.mass), len(mesh.stiffness)), (4, 5))
        self.assertEqual(list(mesh.pinned), [True, False, False, False])
        self.assertTrue(np.array_equal(mesh.positions[1], [2, 0, 0]))
        self.assertEqual(mesh.until, 1)
        cut = text + "v 1 0 0\nv 0 0 0\nv 0 -1 0\nf 5 6 7\n"
        welded = qddot.Scene.from_mesh(
            write("cut.obj", cut), stiffness=10, node_mass=1, weld=1e-9, rotation=[0, 0, 90],
            shift=[0, 0, 1], velocity=[1, 2, 3],
        )  # fmt: skip
        self.assertTrue(np.array_equal(welded.positions[1], [0, 1, 1]))
        self.assertEqual(len(welded.mass), 5)
        self.assertTrue(np.array_equal(welded.velocities, np.tile([1.0, 2, 3], (5, 1))))

    def test_a_mesh_with_loads_density_and_groups(self):
        # A triangle of 1/2 m^2, whose edge from vertex 1 to 2 has the mark 7.
        text = (
            "MeshVersionFormatted 1\nDimension 2\nVertices\n3\n0 0 0\n1 0 0\n0 1 0\n"
            "Triangles\n1\n1 2 3 0\nEdges\n1\n1 2 7\nEnd\n"
        )
        mesh = qddot.Scene.from_mesh(
            write("marked.mesh", text), stiffness=10, density=12, pins=[np.array([0])],
            loads=[(7, [0, 0, 2]), (([0, 0.5, 0], [1, 1, 0]), [1, 0, 0])],
        )  # fmt: skip
        # Equal shares, of numbers without rounding.
        self.assertEqual(list(mesh.mass), [2, 2, 2])
        self.assertEqual(list(mesh.pinned), [True, False, False])
        self.assertEqual(mesh.loads.tolist(), [[0, 0, 2], [0, 0, 2], [1, 0, 0]])
        with self.assertRaisesRegex(ValueError, "mesh.pin.*'left'.*7 of dimension 1"):
            qddot.Scene.from_mesh("marked.mesh", stiffness=10, node_mass=1, pins=["left"])

    def test_loads_pull(self):
        # The oscillator x'' = 3 - 4 x from rest: x = 3/4 (1 - cos 2t).
        held = qddot.Scene(
            [[0.0], [0.0]], [(0, 1)], stiffness=4, mass=1, pinned=[0], rest_length=0,
            load=[[0.0], [3.0]],
        )  # fmt: skip
        end = qddot.solve(held, "exact", step_size=0.1, until=1.0).or_raise().end
        self.assertAlmostEqual(end.q[1, 0], 0.75 * (1 - np.cos(2)), delta=1e-14)

    def test_explanations_and_methods(self):
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
        failed = solve(step_size=0.05, until=10, save_at=np.linspace(0, 10, 11))
        self.assertFalse(failed.success)
        self.assertEqual((failed.outcome, len(failed.t)), ("diverged", len(failed.q)))
        self.assertLess(len(failed.t), 11)
        self.assertTrue(np.all(np.isfinite(failed.end.q)))
        with self.assertRaisesRegex(qddot.RunFailed, "smaller step") as raised:
            failed.or_raise()
        self.assertIs(raised.exception.solution, failed)
        stopped = solve(step_size=1e-7, until=1e3, seconds=0.1)
        self.assertEqual(stopped.outcome, "over_budget")
        chaotic = qddot.solve(qddot.scenes.cloth(nodes=8), accuracy=1e-6, until=30)
        with self.assertRaises(qddot.RunFailed):
            chaotic.or_raise()
        # Options are spelled as here.
        buckled = qddot.scenes.strut().explain()
        for words in (failed.message, failed.diagnosis(), chaotic.message, str(buckled)):
            self.assertTrue(words)
            self.assertNotIn("--", words)
        self.assertIn("accuracy_of", chaotic.message)
        self.assertIn("keep=dimension,mirror", str(buckled))
        with self.assertRaisesRegex(qddot.NoReference, r"\(until\)"):
            qddot.reference(qddot.scenes.lattice(), 1e4, seconds=0.1)

    def test_the_best_run_of_a_chaotic_motion_is_that_motion(self):
        # One step of local_global keeps the energy well, in other modes.
        chain = qddot.scenes.chain(nodes=4, stiffness=1000)
        methods = ["local_global", "blanes_moan6"]
        chart = qddot.work_precision(chain, 12, methods, point_limit=0.2, repeats=1)
        self.assertTrue(chart.reference.beyond_horizon)
        coarse = chart.points[chart.points["method"] == "local_global"][0]
        self.assertLess(coarse["error_energy_max"], 0.5)
        self.assertEqual({chart.best(x).method for x in (0.5, 1e-3)}, {"blanes_moan6"})
        self.assertEqual(chart.record["judged_by"], "energy")

    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "it needs matplotlib")
    def test_a_chart_is_its_points(self):
        seen, methods = [], ["verlet", "implicit_midpoint"]
        chart = qddot.work_precision(CLOTH, 0.1, methods, point_limit=0.05, progress=seen.append)
        self.assertEqual(set(chart.points["method"]), set(methods))
        self.assertEqual({point.method for point in seen}, set(methods))
        for row in chart.front:
            best = chart.best(row["accuracy"])
            found = (best.method, best.value) if best else ("", row["value"])
            np.testing.assert_equal(found, (row["method"], row["value"]))
        self.assertIsNone(chart.best(1e-30))
        chart.save(".")
        names = ["chart.json", "front.csv", "points.csv", "reference.json"]
        self.assertEqual(sorted(os.listdir(".")), names)
        table = problems.read_table("points.csv")
        self.assertTrue(np.array_equal(table["time_s"], chart.points["time_s"], equal_nan=True))
        chart.draw("chart.svg")
        chart.draw("all.svg", everything=True)
        # Pictures spell their option as here.
        for name, words in (("chart.svg", "of 2 methods; everything=True shows"), ("all.svg", "")):
            with open(name, encoding="utf-8") as file:
                text = file.read()
            self.assertIn(words, text)
            self.assertNotIn("--all", text)
        with self.assertRaisesRegex(ValueError, "png"):
            chart.draw("chart.pdf")
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
        self.assertEqual(exact.errors(q, v, t=0.3).position, 0)
        q[2, 1] += 1e-3
        # Over the largest displacement of the motion, which the reference says.
        scale = float(exact.divided_by.split("node, ")[1].split(" m")[0])
        error = exact.errors(q, v, t=0.3).position
        self.assertAlmostEqual(error, 1e-3 / scale, delta=1e-2 * 1e-3 / scale)
        with self.assertRaisesRegex(ValueError, r"errors: q has the shape \(3, 2\)"):
            exact.errors(q[:3], v, t=0.3)
        with self.assertRaisesRegex(ValueError, "ends at t = 0.2"):
            exact.errors(qddot.solve(scene, "verlet", step_size=1e-3, until=0.2))
