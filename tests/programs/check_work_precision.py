"""The chart of methods: its tables, the reference and the record beside them, and its motions."""

import cmath
import math
import os
import shutil

from programs import (
    CHAOS, Programs, header, node, pin, read, rows_of, run, scene, sidecar, spring, study, table,
    write,
)  # fmt: skip

COLUMNS = (
    "scene,method,knob,value,outcome,t_reached,error_position,error_velocity,error_energy,time_s,"
    "time_min_s,setup_s,steps,rejected,force_evaluations,stiffness_evaluations,factorizations,"
    "solves,newton_iterations,"
)
MEASURED = "error_position error_velocity error_energy time_s time_min_s setup_s".split()
# The oscillator runs long enough for Verlet to overflow above its limit; short runs make methods of
# first order run out of time.
CHARTS = {
    ("oscillator", "verlet,implicit_euler,arkode_dirk4,exact", 20),
    ("orbit", "explicit_euler,kahan_li8,ida", 0.5),
}
ORBIT = (
    "work_precision --scene orbit --until 0.1 --methods verlet --accuracies 1e-2 --repeats 1"
    " --out ."
)
JUDGED = (
    "work_precision --scene oscillator --until 2 --methods verlet,rk4,ida,implicit_midpoint"
    " --point-limit 0.05 --repeats 1 --out ."
)
# A pendulum with runs that diverge.
MOVED = (
    "work_precision --scene pendulum --until 1 --methods explicit_euler,verlet,kahan_li8,ida"
    " --point-limit 0.2 --repeats 1 --accuracies 1e-1,1e-3,1e-5 --out ."
)
# Three springs in a row between two pins, compressed.
MOVING = [node(x, 0, velocity=[v, 0], mass=0.1) for x, v in ((0.9, 0.1), (1.8, -0.2))]
BETWEEN = [spring(i, i + 1, 1000, rest_length=1) for i in range(3)]
STRUT = scene([pin(0, 0), *MOVING, pin(2.7, 0)], BETWEEN, until=0.7)


def charts():
    """The two charts, each with its scene, methods and horizon."""
    for drawn, methods, until in CHARTS:
        line = (
            f"work_precision --scene {drawn} --until {until} --methods {methods} --point-limit 0.3"
            " --repeats 1 --out deep/er"
        )
        yield study(line), drawn, methods.split(","), until


def reached(rows):
    return [row for row in rows if row["outcome"] == "reached_end"]


def copy_of(done, *names):
    for name in names:
        shutil.copy(done / name, name)


class Charts(Programs):
    def test_it_writes_its_tables_and_their_sidecars(self):
        methods = {row["name"]: row for row in rows_of(run("simulate --list-methods --csv").stdout)}
        for done, drawn, names, _ in charts():
            out = done / "deep/er"
            written = "chart.json front.csv front.json points.csv points.json reference.json"
            self.assertEqual((sorted(os.listdir(out)), done.err), (written.split(), ""))
            self.assertTrue(header(out + "/points.csv").startswith(COLUMNS))
            self.assertTrue(header(out + "/front.csv").startswith("scene,accuracy,method,"))
            for name in ("points.json", "front.json", "reference.json"):
                keys = "command_line scene version compiler flags cpu libraries date"
                self.assertLessEqual(set(keys.split()), sidecar(f"{out}/{name}").keys())
            # The sidecar has the words for those who show the points.
            origin, rows = sidecar(out + "/points.json"), table(out + "/points.csv")
            self.assertEqual([note["name"] for note in origin["methods"]], names)
            for note in origin["methods"]:
                self.assertEqual(note["summary"], methods[note["name"]]["summary"])
                takes_solver = note["name"] in ("implicit_euler", "arkode_dirk4", "ida")
                self.assertEqual("--solver" in note["takes"], takes_solver)
            outcomes = {row["outcome"] for row in rows} - {"reached_end"}
            self.assertEqual(origin["outcomes"].keys(), outcomes)
            self.assertTrue(all(origin["outcomes"].values()))
            reduced = origin["reduced"]
            self.assertEqual(sidecar(out + "/front.json")["reduced"], reduced)
            found = [reduced[k] for k in ("unknowns", "unknowns_drawn", "stiffness_is_constant")]
            found += [note["name"] for note in reduced["reductions"][1:]]
            orbit, line = [2, 6, False, "dimension"], [1, 2, True, "constant_stiffness"]
            self.assertEqual(found, orbit if drawn == "orbit" else line)
            self.near(reduced["omega_max"], 10, 1e-9)
            self.assertEqual((reduced["parts"], reduced["unstable_directions"]), (1, 0))

    def test_each_method_has_its_points_in_the_order_asked_for(self):
        for done, drawn, names, _ in charts():
            rows = done.table("deep/er/points.csv")
            self.assertEqual(list(dict.fromkeys(row["method"] for row in rows)), names)
            for one, next_one in zip(rows, rows[1:]):
                self.assertEqual(one["scene"], drawn)
                self.assertGreater(one["value"], 0)
                self.assertEqual(one["knob"] == "rtol", one["method"] in ("ida", "arkode_dirk4"))
                if one["method"] == next_one["method"]:
                    self.assertLess(next_one["value"], one["value"])

    def test_what_was_measured_is_there_and_the_rest_is_empty(self):
        outcomes = set()
        for done, drawn, _, until in charts():
            rows = done.table("deep/er/points.csv")
            certified = done.sidecar("deep/er/reference.json")["certified_position"]
            outcomes |= {row["outcome"] for row in rows}
            for row in rows:
                if row["outcome"] != "reached_end":
                    self.assertEqual({row[name] for name in MEASURED}, {None})
                    self.assertLess(row["t_reached"], until)
                    continue
                self.assertGreaterEqual(min(row[name] for name in MEASURED), 0)
                self.assertEqual(row["t_reached"], until)
                self.assertTrue(row["steps"] > 0 and 0 < row["time_min_s"] <= row["time_s"])
                error = row["error_position"]
                self.assertEqual(row["error_position_at_most"], error + certified)
                self.assertEqual(row["error_position_at_least"], max(error - certified, 0))
                self.assertGreaterEqual(row["error_energy_max"], row["error_energy"])
                # The orbit turns about its pin; the oscillator has nothing that turns.
                self.assertEqual(row["error_momentum_max"] is None, drawn == "oscillator")
                self.assertIsNone(row["error_modal_shares"])
            errors = [(row["error_energy_max"], row["error_energy"]) for row in reached(rows)]
            self.assertTrue(any(most > 2 * at_end for most, at_end in errors))
        self.assertLessEqual({"reached_end", "diverged", "over_budget"}, outcomes)

    def test_errors_are_those_of_the_closed_form(self):
        (done,) = (chart for chart, drawn, _, _ in charts() if drawn == "oscillator")
        rows = reached(done.table("deep/er/points.csv"))
        rows = [row for row in rows if row["method"] == "verlet"]
        self.assertGreater(len(rows), 3)
        for row in rows:
            # x = cos 10 t, which is up to 2 m away from where it starts; Verlet's steps turn by the
            # angle of 1 - (h w)^2/2.
            steps, angle = row["steps"], cmath.acos(1 - (200 / row["steps"]) ** 2 / 2)
            error = abs(cmath.cos(steps * angle) - math.cos(200)) / 2
            self.near(row["error_position"], error, 1e-3 * error + 1e-13)

    def test_the_reference_says_how_it_was_made_and_how_far_it_holds(self):
        for done, drawn, _, until in charts():
            reference = done.sidecar("deep/er/reference.json")
            for part in ("position", "velocity", "energy"):
                certified = reference[f"certified_{part}"]
                self.assertTrue(0 < certified < 1e-11)
                self.near(reference["certified_digits"][part], -math.log10(certified), 0.11)
            self.holds(reference["made_by"], "kahan_li8", ";")
            self.assertEqual(reference["t"], until)
            self.assertEqual(len(reference["q"]), 2 if drawn == "orbit" else 1)
            self.assertGreater(reference["seconds"], 0)

    def test_symmetric_and_chaotic_motions_are_told_and_judged_by_what_is_known(self):
        for text, words, judged_by, facts in (
            (STRUT, ("exists only in exact symmetry", "divided by the largest"), "position",
             {"only_symmetric": True, "beyond_horizon": False}),
            (CHAOS, ("chaotic", "Lyapunov", "Position errors at the end mean nothing"), "energy",
             {"beyond_horizon": True}),
        ):  # fmt: skip
            write("scene.toml", text)
            line = "work_precision --scene scene.toml --methods blanes_moan6 --repeats 1 --out out"
            self.holds(self.done(line + " --force").stdout, *words)
            reference = sidecar("out/reference.json")
            self.assertLessEqual(facts.items(), reference.items())
            row = table("out/front.csv")[3]
            self.assertEqual((row["judged_by"], row["method"]), (judged_by, "blanes_moan6"))
            if text is STRUT:
                self.assertLess(reference["out_of_symmetry"]["horizon"], 0.7)
                continue
            self.assertTrue(6 < reference["horizon"] < 12)
            self.assertGreater(reference["lyapunov"], 1)
            last = table("out/points.csv")[-1]
            self.assertLess(last["error_energy_max"], 1e-6)
            self.assertGreater(last["error_position"], 1e-2)
            self.assertLess(last["error_modal_shares"], 1)

    def test_no_method_goes_beyond_the_finest_accuracy_that_is_asked_for(self):
        self.done(
            "work_precision --scene pendulum --until 0.5 --methods rk4,trapezoidal,ida"
            " --accuracies 1e-4,1e-2 --point-limit 0.1 --repeats 1 --out ."
        )
        rows = reached(table("points.csv"))
        for method in ("rk4", "trapezoidal", "ida"):
            own = [row for row in rows if row["method"] == method]
            fine = [row["error_position_at_most"] <= 1e-4 for row in own]
            # Near rk4's limit of stability steps are taken closer, up to the first that will do. Errors
            # of ida do not follow its tolerances closely: one run may do by luck, a second tells.
            self.assertIn(True, fine)
            most = {"rk4": len(fine), "trapezoidal": 1, "ida": 2}[method]
            self.assertLessEqual(len(fine) - fine.index(True), most)
        self.assertEqual([row["accuracy"] for row in table("front.csv")], [1e-2, 1e-4])

    def test_where_all_is_pinned_every_method_is_exact(self):
        name = 'a, "b"'
        springs = [spring(0, 1, 10, rest_length=0.5)]
        pins = [pin(0, 0, velocity=[1, 1]), pin(1, 0)]
        write("s.toml", scene(pins, springs, name=name, until=0.5))
        self.done("work_precision --scene s.toml --point-limit 0.05 --repeats 1 --out out")
        rows = table("out/points.csv")
        self.assertGreater(len(rows), 60)
        for row in rows:
            kept = (row["scene"], row["outcome"], row["error_position"])
            self.assertEqual(kept, (name, "reached_end", 0))
        self.assertEqual({row["scene"] for row in table("out/front.csv")}, {name})
        listed = {row["name"] for row in rows_of(run("simulate --list-methods --csv").stdout)}
        self.assertEqual({row["method"] for row in rows}, listed)
        line = "simulate --scene s.toml --final f.csv --energy e.csv --every 0.25 --method "
        for method in ("verlet --step-size 0.01", "bdf2 --step-size 0.01", "ida --rtol 1e-4"):
            self.done(line + method)
            self.assertEqual(read("f.csv"), "node,x,y,vx,vy\n0,0,0,0,0\n1,1,0,0,0\n")
            for row in table("e.csv"):
                self.assertEqual((row["kinetic"], row["total"]), (0, 1.25))

    def test_options_reach_the_runs(self):
        def rows(methods, more, scene="orbit --until 0.5"):
            self.done(
                f"work_precision --scene {scene} --methods {methods} --repeats 1"
                f" --point-limit 100 --accuracies 1e-2,1e-3 {more} --out ."
            )
            return table("points.csv")

        low = rows("ida,cvode_bdf,cvode_adams", "--max-order 5 --max-order 1")  # the last counts
        self.assertEqual({(row["order_mean"], row["order_reductions"]) for row in low}, {(1, 0)})
        own = rows("ida,verlet,trapezoidal,arkode_dirk4,arkode_trbdf2", "")
        for row in own:
            is_adaptive = row["method"] == "ida"
            self.assertEqual(row["order_mean"] is not None, is_adaptive)
            self.assertTrue(is_adaptive or row["order_reductions"] == 0)
            self.assertTrue(0 <= row["indefinite_factorizations"] <= row["factorizations"])
        self.assertTrue(all(1 < row["order_mean"] < 5 for row in own if row["method"] == "ida"))
        loose, tight = (
            rows("trapezoidal", f"--solve-tolerance {part}")[3] for part in ("1e-2", "1e-12")
        )
        self.assertEqual(tight["steps"], loose["steps"])
        self.assertGreater(tight["newton_iterations"], loose["newton_iterations"])
        alpha = "generalized_alpha"
        damped, undamped = (rows(alpha, f"--spectral-radius {part}")[5] for part in "01")
        self.assertGreater(damped["error_energy"], 10 * undamped["error_energy"])
        plain, detecting = (
            {row["method"]: row["order_mean"] for row in rows(both, more, "fpu --until 20")
             if row["value"] == 1e-5}
            for both in ["cvode_bdf,cvode_adams"] for more in ("", "--stability-detection")
        )  # fmt: skip
        self.assertLess(detecting["cvode_bdf"], plain["cvode_bdf"])
        self.assertEqual(detecting["cvode_adams"], plain["cvode_adams"])

    def test_steps_that_a_stiff_spring_holds_are_counted(self):
        # A slow vibration of two masses that a spring 1e6 times stiffer holds together.
        nodes = [pin(0), node(1, mass=1), node(2, mass=1)]
        springs = [spring(0, 1, 1, rest_length=0), spring(1, 2, 1e6)]
        write("held.toml", scene(nodes, springs, until=0.5))
        self.done(
            "work_precision --scene held.toml --methods verlet,arkode_erk4,arkode_dirk4"
            " --point-limit 0.05 --repeats 1 --out ."
        )
        held = {row["method"] for row in table("points.csv") if row["stability_limited_steps"] > 0}
        self.assertEqual(held, {"arkode_erk4"})


class Records(Programs):
    """The record of a chart, chart.json, and how it is made anew from tables."""

    def setUp(self):
        super().setUp()
        self.measured = study(JUDGED).sidecar("chart.json")
        copy_of(study(JUDGED), "points.csv", "points.json", "front.csv", "reference.json")

    def judge(self):
        self.done("work_precision --judge .")
        return sidecar("chart.json")

    def front(self, chart):
        return [row["point"] for row in chart["rows"]]

    def test_the_record_has_the_front_of_the_table(self):
        points, front = table("points.csv"), table("front.csv")
        self.assertEqual(len(self.measured["knobs"]), len(points))
        self.assertEqual(self.measured["judged_by"], "position")
        self.assertGreater(len(front) - self.front(self.measured).count(None), 4)
        for row, written in zip(self.measured["rows"], front, strict=True):
            self.assertEqual(row["accuracy"], written["accuracy"])
            self.assertEqual(row["point"] is None, written["method"] is None)
            self.assertNotEqual(row["why_empty"] is None, row["point"] is None)
            if row["point"] is not None:
                for column in "scene method knob value error_position time_s".split():
                    self.assertEqual(points[row["point"]][column], written[column])
                self.assertEqual(row["margin"], written["stability_margin"])

    def test_it_is_made_anew_from_the_tables(self):
        made = self.judge()
        for part in (
            "judged_by scene until certified accuracies caveats displacements knobs times"
            " quantities staircases crossings"
        ).split():
            self.assertEqual(made[part], self.measured[part], part)
        # Margins come from a margin in front.csv, and back.
        for one, other in zip(made["margins"], self.measured["margins"], strict=True):
            self.assertEqual(one is None, other is None)
            self.near(one or 0, other or 0, 1e-12)
        self.assertEqual(self.front(made), self.front(self.measured))
        # Points alone say what their bounds say; its own record is replaced.
        for name in ("points.json", "front.csv", "reference.json"):
            os.remove(name)
        chart = self.judge()
        self.near(chart["certified"] / self.measured["certified"], 1, 1e-2)
        self.assertEqual(self.front(chart), self.front(self.measured))

    def test_a_reference_of_another_hand_is_not_replaced(self):
        for text in ("{", "[]", "my notes"):
            write("reference.json", text)
            self.refused(ORBIT, "reference.json", "--force")
            self.assertEqual(read("reference.json"), text)

    def test_folders_that_cannot_be_read_are_refused_in_a_sentence(self):
        line = "work_precision --judge ."
        self.refused(line + " --scene oscillator", "--scene", "--judge")
        for name, text, *said in (
            ("front.csv", "accuracy,method,value,stability_margin\n2,verlet,1,\n", "row 1", "'2'"),
            ("front.csv", "scene\n", "accuracy"), ("front.csv", None), ("reference.json", "{", ""),
            ("reference.json", '{"certified_position": "small"}', ""), ("reference.json", None),
            ("points.csv", "scene\n", "method"), ("points.csv", None, ""),
        ):  # fmt: skip
            os.remove(name) if text is None else write(name, text)
            if said:
                self.refused(line, name, *said)
        copy_of(study(JUDGED), "points.csv")
        write("chart.json", '{"mine": 1}\n')
        self.refused(line, "chart.json")
        self.assertEqual(read("chart.json"), '{"mine": 1}\n')


class Motions(Programs):
    """The motions of a chart's runs, kept beside it."""

    def keep(self, more):
        return self.done("motions --scene pendulum --out . " + more)

    def setUp(self):
        super().setUp()
        copy_of(study(MOVED), "points.csv", "points.json", "reference.json")
        self.points = {(row["method"], row["value"]): row for row in table("points.csv")}

    def test_every_run_that_ended_in_time_has_the_motion_of_the_chart(self):
        self.keep("--frames 40 --runs 1000")
        reference, *runs = table("motions.csv")
        self.assertEqual(reference["role"], "reference")
        outcomes = [row["outcome"] for row in self.points.values()]
        self.assertEqual(len(runs), len(outcomes) - outcomes.count("over_budget"))
        origin = sidecar("reference.json")
        # Rounding, or what the reference is certified to: runs come as near at the best.
        error = sidecar("motions.json")["reference_error"]
        self.assertIn(f"within {error:.1e} of the reference", reference["why"])
        self.assertLessEqual(error, 10 * origin["certified_position"])
        energies = {}
        for row in table("motions_energy.csv"):
            energies.setdefault(row["file"], []).append(row["total"])
            self.assertEqual(row["total"], row["kinetic"] + row["potential"])
        for row in runs:
            point, totals = self.points[row["method"], row["value"]], energies[row["file"]]
            self.assertTrue(os.path.exists(row["file"]))
            # Single frames and an .xdmf would be most of the bytes. The layout of a small file has
            # some 20 kB, and frames of two nodes 64 bytes each.
            self.assertLess(os.path.getsize(row["file"]), 40_000)
            self.assertFalse(os.path.exists(row["file"].replace(".vtkhdf", ".xdmf")))
            self.assertLessEqual(len(totals), row["frames"])
            self.assertEqual((row["role"], row["outcome"]), ("run", point["outcome"]))
            self.assertEqual(row["t_reached"], point["t_reached"])
            phases = ("force", "stiffness", "factorization", "solve")
            self.assertLessEqual(sum(row[f"seconds_{phase}"] for phase in phases), row["seconds"])
            self.assertGreater(row["seconds"], 0)
            if row["outcome"] != "reached_end":
                self.assertLessEqual(row["frames"], 1 + 40 * point["t_reached"] + 1e-9)
            elif row["method"] == "ida":
                # Its steps end at the frames: it has few of these and still takes other steps.
                self.assertLessEqual(4 * (row["frames"] - 1), max(4, point["steps"]))
            else:
                self.assertEqual((row["frames"], len(totals)), (41, 41))
                # Energies are sums of a few terms of size `kinetic`, each rounded.
                drift = abs(totals[-1] - totals[0]) / origin["scales"]["kinetic"]
                self.near(drift, point["error_energy"], 1e-13 + 1e-9 * point["error_energy"])
                nearest = point["error_position"] - 2 * error
                self.assertGreaterEqual(row["largest_distance"], nearest)

    def test_only_motions_of_the_folder_are_replaced(self):
        self.keep("--runs 4 --frames 3")
        # Rows that name other files; such files stay.
        write("mine.vtkhdf", "mine")
        first, *rest = read("motions.csv").split("\n", 2)[1].split(",", 1)
        with open("motions.csv", "a", encoding="utf-8") as file:
            for name in ("mine.vtkhdf", "motions/../mine.vtkhdf", "motions/other.txt"):
                file.write(f"{name},{rest[0]}\n")
        self.keep("--runs 2 --frames 3")
        self.assertEqual(read("mine.vtkhdf"), "mine")
        rows = table("motions.csv")
        self.assertEqual([row["frames"] for row in rows], [4, 4, 4])
        stems = {row["file"].removesuffix(".vtkhdf").removeprefix("motions/") for row in rows}
        endings = ("vtkhdf", "vtkhdf.json")
        self.assertEqual(set(os.listdir("motions")), {f"{s}.{e}" for s in stems for e in endings})
        # A file that somebody else put in the place of a motion stays as well.
        for ending in ("", ".json"):
            os.remove(rows[1]["file"] + ending)
        write(rows[1]["file"], "mine")
        line = "motions --scene pendulum --out . --runs 2 --frames 3"
        self.refused(line, rows[1]["file"], "--force")
        self.assertEqual(read(rows[1]["file"]), "mine")

    def test_an_interruption_leaves_the_motions_of_before(self):
        self.keep("--runs 1000 --frames 3")
        before = read("motions.csv"), sorted(os.listdir("motions"))
        # So soon that fewer runs are made than there are, whether the program has begun or not.
        for limit in ("1e-4", "0.05"):
            ended = run(f"motions --scene pendulum --out . --frames 10000 --time-limit {limit}")
            self.assertEqual(ended.returncode, 3)
            self.assertEqual((read("motions.csv"), sorted(os.listdir("motions"))), before)

    def test_what_cannot_be_is_said_in_a_sentence(self):
        line = "motions --scene pendulum --out . "
        self.refused("motions --scene orbit --out .", "--scene orbit", "another scene")
        self.refused(line + "--frames 0", "--frames 0", "1 to 10000")
        self.refused(line + "--runs -1", "--runs -1")
        # Numbers that nobody wrote, and files that are missing.
        value = read("points.csv").split("\n")[1].split(",")[3]
        for name, old, new, *said in (
            ("points.csv", value, "-1", "row 1", "value -1"),
            ("points.csv", value, "nan", "row 1", "value"),
            ("points.json", '"until": 1.0', '"until": -3.0', "until"),
        ):
            text = read(name)
            write(name, text.replace(old, new, 1))
            self.refused(line, *said)
            write(name, text)
        for name, said in ("points.json", "it is missing"), ("points.csv", "it cannot be read"):
            os.remove(name)
            self.refused(line, f"{name}: {said}")
