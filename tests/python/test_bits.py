"""Results are the programs', to the last bit."""

import json
import os
import tempfile
import unittest

import numpy as np

import problems
import qddot

# A method of each way to step: explicit, symplectic, Nystrom, multistep, implicit, SUNDIALS'.
METHODS = {
    "verlet": {"step_size": 1e-3},
    "blanes_moan6": {"step_size": 2e-3},
    "symmetric8": {"step_size": 1e-3},
    "dprkn8": {"rtol": 1e-7},
    "implicit_midpoint": {"step_size": 5e-3},
    "rodas4": {"rtol": 1e-4},
    "generalized_alpha": {"step_size": 5e-3, "spectral_radius": 0.6},
    "semi_implicit_euler": {"step_size": 1e-3},
    "arkode_dirk4": {"rtol": 1e-5},
    "cvode_bdf": {"rtol": 1e-6, "max_order": 3},
    "ida": {"rtol": 1e-5},
}


class Bits(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def check_nodes(self, table, q, v):
        axes = "xyz"[: q.shape[-1]]
        for d, axis in enumerate(axes):
            self.assertTrue(np.array_equal(table[axis], q[..., d].reshape(-1)), axis)
            self.assertTrue(np.array_equal(table["v" + axis], v[..., d].reshape(-1)), "v" + axis)

    def test_runs(self):
        until, every = 0.1, 0.02
        drawn = [problems.random_scene(1), problems.random_scene(2, dimension=2)]
        for scene in (
            *drawn,
            qddot.scenes.cloth(nodes=6),
            qddot.scenes.lattice(nodes_x=3, nodes_y=3, nodes_z=4, stiffness=100.0),
        ):
            scene.save(self.path("scene.toml"))
            for method, options in METHODS.items():
                with self.subTest(scene=scene.name, method=method):
                    words = [
                        word
                        for name, value in options.items()
                        for word in ("--" + name.replace("_", "-"), value)
                    ]
                    _, err, status = problems.run_program(
                        "simulate", "--scene", self.path("scene.toml"), "--method", method, *words,
                        "--until", until, "--final", self.path("f.csv"), "--trajectory",
                        self.path("t.csv"), "--every", every, "--energy", self.path("e.csv"),
                        "--every", every,
                    )  # fmt: skip
                    self.assertEqual(status, 0, err)
                    energy = problems.read_table(self.path("e.csv"))
                    times = energy["t"]
                    # The program looks at the start before its run.
                    solution = qddot.solve(
                        scene, method, until=until, save_at=times[1:], **options
                    ).or_raise()
                    self.assertEqual(solution.t[-1], until)
                    path = problems.read_table(self.path("t.csv"))
                    nodes = len(scene.mass)
                    later = {name: column[nodes:] for name, column in path.items()}
                    self.check_nodes(later, solution.q, solution.v)
                    final = problems.read_table(self.path("f.csv"))
                    self.check_nodes(final, solution.end.q, solution.end.v)
                    for name in ("kinetic", "potential", "total"):
                        same = np.array_equal(energy[name][1:], getattr(solution.energy, name))
                        self.assertTrue(same, name)

    def test_failures_are_the_programs(self):
        scene = qddot.scenes.cloth(nodes=8)
        scene.save(self.path("scene.toml"))
        _, _, status = problems.run_program(
            "simulate", "--scene", self.path("scene.toml"), "--method", "verlet", "--step-size", 0.02,
            "--until", 20, "--final", self.path("f.csv"),
        )  # fmt: skip
        self.assertEqual(status, 3)
        with open(self.path("f.json"), encoding="utf-8") as file:
            sidecar = json.load(file)
        solution = qddot.solve(scene, "verlet", step_size=0.02, until=20)
        self.assertEqual(solution.outcome, sidecar["outcome"])
        self.assertEqual(solution.t_reached, sidecar["t_reached"])
        final = problems.read_table(self.path("f.csv"))
        self.check_nodes(final, solution.end.q, solution.end.v)
        self.assertIn("above verlet's limit", solution.diagnosis())

    def test_statics_and_modes(self):
        scene = qddot.scenes.cloth(nodes=6)
        scene.save(self.path("scene.toml"))
        rest = ("--scene", self.path("scene.toml"))
        self.assertEqual(
            problems.run_program("equilibrium", *rest, "--final", self.path("e.csv"))[2], 0
        )
        found = qddot.equilibrium(scene)
        self.check_nodes(
            problems.read_table(self.path("e.csv")), found.positions, 0 * found.positions
        )
        self.assertTrue(found.isolated)
        words = ("--count", 4, "--at", "equilibrium", "--out", self.folder)
        self.assertEqual(problems.run_program("modes", *rest, *words)[2], 0)
        table = problems.read_table(self.path("modes.csv"))
        modes = qddot.modes(scene, 4, at_equilibrium=True)
        self.assertTrue(np.array_equal(table["omega"][:4], modes.omega))
        shapes = problems.read_table(self.path("shapes.csv"))
        for d, axis in enumerate("xyz"):
            same = np.array_equal(shapes["d" + axis], modes.shapes[..., d].reshape(-1))
            self.assertTrue(same, axis)
        # M-orthonormal, whoever computes it.
        x = modes.shapes.reshape(4, -1)
        m = np.repeat(scene.mass, 3)
        self.assertLess(np.max(np.abs(x * m @ x.T - np.eye(4))), 1e-10)

    def test_charts(self):
        scene = qddot.scenes.cloth(nodes=6)
        scene.save(self.path("scene.toml"))
        methods = ["verlet", "implicit_midpoint", "arkode_erk4"]
        _, err, status = problems.run_program(
            "work_precision", "--scene", self.path("scene.toml"), "--methods", ",".join(methods),
            "--until", 0.1, "--point-limit", 0.1, "--out", self.folder,
        )  # fmt: skip
        self.assertEqual(status, 0, err)
        table = problems.read_table(self.path("points.csv"))
        chart = qddot.work_precision(scene, until=0.1, methods=methods, point_limit=0.1, repeats=1)
        self.assertEqual(list(table), list(chart.points.dtype.names))
        mine = {(row["method"], row["value"]): row for row in chart.points}
        compared = 0
        for i, method in enumerate(table["method"]):
            row = mine.get((method, table["value"][i]))
            if (
                row is None
                or row["outcome"] != "reached_end"
                or table["outcome"][i] != "reached_end"
            ):
                continue  # which rungs are taken near a limit, and how far down, depends on time
            compared += 1
            for name in ("error_position", "error_velocity", "error_energy", "error_momentum_max"):
                same = np.array_equal(table[name][i], row[name], equal_nan=True)
                self.assertTrue(same, (method, row["value"], name))
            for name in ("steps", "force_evaluations", "factorizations", "solves"):
                self.assertEqual(table[name][i], row[name], (method, row["value"], name))
        self.assertGreater(compared, 20)

    def test_exchange(self):
        words = (
            "--methods",
            "verlet,trbdf2",
            "--h-omega",
            "0.5",
            "--until",
            20,
            "--out",
            self.folder,
        )
        self.assertEqual(problems.run_program("exchange", "--scene", "fpu", *words)[2], 0)
        table = problems.read_table(self.path("exchange.csv"))
        made = qddot.exchange(qddot.scenes.fpu(), ["verlet", "trbdf2"], [0.5], until=20)
        for run in (made.reference, *made.runs):
            of_run = (table["method"] == run.method) & (table["spring"] != "sum")
            energies = table["energy"][of_run].reshape(run.energies.shape)
            self.assertTrue(np.array_equal(energies, run.energies), run.method)
        summary = problems.read_table(self.path("summary.csv"))
        self.assertEqual(list(summary["verdict"][1:]), [run.verdict for run in made.runs])

    def test_energy_trends(self):
        words = ("--methods", "verlet", "--step-size", 0.01, "--until", 200, "--out", self.folder)
        self.assertEqual(problems.run_program("energy_drift", "--scene", "orbit", *words)[2], 0)
        table = problems.read_table(self.path("drift.csv"))
        trend = qddot.energy_trend(qddot.scenes.orbit(), "verlet", step_size=0.01, until=200)
        self.assertTrue(np.array_equal(table["t"], trend.t))
        self.assertTrue(np.array_equal(table["relative_error"], trend.error))
        summary = problems.read_table(self.path("summary.csv"))
        self.assertEqual(summary["verdict"][0], trend.words)

    def test_answers(self):
        # Which method is chosen depends on time; what it then gives does not.
        scene = problems.random_scene(3)
        answer = qddot.solve(scene, accuracy=1e-6, until=0.2).or_raise()
        self.assertLessEqual(answer.error_estimate, 1e-6)
        again = qddot.solve(scene, answer.method, until=0.2, **{answer.knob: answer.value})
        self.assertTrue(np.array_equal(again.end.q, answer.end.q))
        exact = qddot.reference(scene, 0.2)
        self.assertLess(exact.certified.position, 1e-10)
        self.assertLessEqual(exact.errors(answer).position, answer.error_estimate)


if __name__ == "__main__":
    unittest.main()
