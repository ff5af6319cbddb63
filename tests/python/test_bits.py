"""Results are the programs', to the last bit."""

import re

import numpy as np

import qddot
from problems import random_scene, read_table
from programs import Programs, run, sidecar

# A method of each way to step: explicit, symplectic, Nystrom, multistep, implicit, SUNDIALS'.
METHODS = {
    "verlet": {"step_size": 1e-3}, "blanes_moan6": {"step_size": 2e-3},
    "symmetric8": {"step_size": 1e-3}, "dprkn8": {"rtol": 1e-7},
    "implicit_midpoint": {"step_size": 5e-3, "solve_tolerance": 1e-4}, "rodas4": {"rtol": 1e-4},
    "generalized_alpha": {"step_size": 5e-3, "spectral_radius": 0.6},
    "semi_implicit_euler": {"step_size": 1e-3}, "arkode_dirk4": {"rtol": 1e-5},
    "cvode_bdf": {"rtol": 1e-6, "max_order": 3}, "ida": {"rtol": 1e-5, "atol": 1e-6},
}  # fmt: skip


class Bits(Programs):
    def run_on(self, scene, line, status=0):
        """Runs a program on a scene, or on one of this name; options to files stand for themselves,
        as --final."""
        if not isinstance(scene, str):
            scene.save("scene.toml")
            scene = "scene.toml"
        named = re.sub("--(final|trajectory|energy)", r"--\1 \1.csv", line)
        named += f" --scene {scene}" + (" --out ." if named == line else "")
        self.assertEqual(run(named).returncode, status)

    def check_nodes(self, table, q, v, prefixes=("", "v")):
        for d, axis in enumerate("xyz"[: q.shape[-1]]):
            for prefix, values in zip(prefixes, (q, v)):
                same = np.array_equal(table[prefix + axis], values[..., d].reshape(-1))
                self.assertTrue(same, prefix + axis)

    def test_runs(self):
        for scene in (
            random_scene(1), random_scene(2, dimension=2),
            qddot.scenes.lattice(nodes_x=3, nodes_y=3, nodes_z=4, stiffness=100.0),
        ):  # fmt: skip
            for method, options in METHODS.items():
                with self.subTest(scene=scene.name, method=method):
                    knobs = [f"--{name.replace('_', '-')} {x}" for name, x in options.items()]
                    every = "--final --trajectory --every 0.02 --energy --every 0.02"
                    words = f"--method {method} {' '.join(knobs)} --until 0.1 {every}"
                    self.run_on(scene, "simulate " + words)
                    energy = read_table("energy.csv")
                    # The program looks at the start before its run.
                    times = energy["t"][1:]
                    run = dict(until=0.1, save_at=times, **options)
                    solution = qddot.solve(scene, method, **run).or_raise()
                    self.assertEqual(solution.t[-1], 0.1)
                    path, nodes = read_table("trajectory.csv"), len(scene.mass)
                    later = {name: column[nodes:] for name, column in path.items()}
                    self.check_nodes(later, solution.q, solution.v)
                    self.check_nodes(read_table("final.csv"), solution.end.q, solution.end.v)
                    for name in ("kinetic", "potential", "total"):
                        same = np.array_equal(energy[name][1:], getattr(solution.energy, name))
                        self.assertTrue(same, name)

    def test_failures_are_the_programs(self):
        scene = qddot.scenes.cloth(nodes=8)
        words = "--method verlet --step-size 0.02 --until 20 --final"
        self.run_on(scene, "simulate " + words, status=3)
        solution = qddot.solve(scene, "verlet", step_size=0.02, until=20)
        self.assertEqual(solution.outcome, sidecar("final.json")["outcome"])
        self.assertEqual(solution.t_reached, sidecar("final.json")["t_reached"])
        self.check_nodes(read_table("final.csv"), solution.end.q, solution.end.v)
        self.assertIn("above verlet's limit", solution.diagnosis())

    def test_statics_and_modes(self):
        scene = qddot.scenes.cloth(nodes=6)
        self.run_on(scene, "equilibrium --final")
        found = qddot.equilibrium(scene)
        self.check_nodes(read_table("final.csv"), found.positions, 0 * found.positions)
        self.assertTrue(found.isolated)
        self.run_on(scene, "modes --count 4 --at equilibrium")
        modes = qddot.modes(scene, 4, at_equilibrium=True)
        self.assertTrue(np.array_equal(read_table("modes.csv")["omega"][:4], modes.omega))
        self.check_nodes(read_table("shapes.csv"), modes.shapes, None, ("d",))

    def test_charts(self):
        scene, methods = qddot.scenes.cloth(nodes=6), ["verlet", "implicit_midpoint", "arkode_erk4"]
        words = f"--methods {','.join(methods)} --until 0.1 --point-limit 0.1 --repeats 1"
        self.run_on(scene, "work_precision " + words)
        table = read_table("points.csv")
        chart = qddot.work_precision(scene, until=0.1, methods=methods, point_limit=0.1, repeats=1)
        self.assertEqual(tuple(table), chart.points.dtype.names)
        mine, compared = {(row["method"], row["value"]): row for row in chart.points}, 0
        numbers = [name for name in table if chart.points.dtype[name].kind != "U"]
        names = [name for name in numbers if not name.endswith("_s") and name != "timed_runs"]
        for i, key in enumerate(zip(table["method"], table["value"])):
            # Which rungs are taken near a limit, and how far down, depends on time.
            row = mine.get(key)
            if row is None or {row["outcome"], table["outcome"][i]} != {"reached_end"}:
                continue
            compared += 1
            for name in names:
                same = np.array_equal(table[name][i], row[name], equal_nan=True)
                self.assertTrue(same, (key, name))
        self.assertGreater(compared, 20)

    def test_exchange_and_energy_trends(self):
        self.run_on("fpu", "exchange --methods verlet,trbdf2 --h-omega 0.5 --until 20")
        table, fpu = read_table("exchange.csv"), qddot.scenes.fpu()
        made = qddot.exchange(fpu, ["verlet", "trbdf2"], [0.5], until=20)
        for run in (made.reference, *made.runs):
            of_run = (table["method"] == run.method) & (table["spring"] != "sum")
            energies = table["energy"][of_run].reshape(run.energies.shape)
            self.assertTrue(np.array_equal(energies, run.energies), run.method)
        verdicts = list(read_table("summary.csv")["verdict"][1:])
        self.assertEqual(verdicts, [run.verdict for run in made.runs])
        words = "--methods verlet --step-size 0.01 --until 200 --force"
        self.run_on("orbit", "energy_drift " + words)
        table = read_table("drift.csv")
        trend = qddot.energy_trend(qddot.scenes.orbit(), "verlet", step_size=0.01, until=200)
        self.assertTrue(np.array_equal(table["t"], trend.t))
        self.assertTrue(np.array_equal(table["relative_error"], trend.error))
        self.assertEqual(read_table("summary.csv")["verdict"][0], trend.words)

    def test_answers(self):
        # Which method is chosen depends on time; what it then gives does not.
        scene = random_scene(3)
        answer = qddot.solve(scene, accuracy=1e-6, until=0.2).or_raise()
        self.assertLessEqual(answer.error_estimate, 1e-6)
        again = qddot.solve(scene, answer.method, until=0.2, **{answer.knob: answer.value})
        self.assertTrue(np.array_equal(again.end.q, answer.end.q))
        exact = qddot.reference(scene, 0.2)
        self.assertLess(exact.certified.position, 1e-10)
        self.assertLessEqual(exact.errors(answer).position, answer.error_estimate)
