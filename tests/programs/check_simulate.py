"""simulate: its tables, sidecars, scenes, lists and warnings, and why a run failed."""

import math
import os
import re

from programs import (
    Programs, node, pin, read, rows_of, run, scene, sidecar, spring, table, write,
)  # fmt: skip

# Frequencies: the oscillator's w is 10 rad/s.
OSCILLATOR = "simulate --scene oscillator --method "
# Masses that fall freely, with a pinned node in the middle of the list; that node's velocity is for
# nothing.
UNTIL, STEP = 0.5, 0.001
MASSES = [1, None, 2]
POSITIONS = [(0.0, 0.0, 0.0), (1.1, 0.2, 0.3), (2.3, -0.4, 0.1)]
VELOCITIES = [(0.0, 0.0, 0.0), (5.0, 5.0, 5.0), (-0.3, 0.7, 0.2)]
GRAVITY = (1.0, -9.0, 0.5)


def falling(dimension):
    nodes = [
        node(*x[:dimension], velocity=list(v[:dimension]), mass=m or 0, pinned=m is None)
        for x, v, m in zip(POSITIONS, VELOCITIES, MASSES)
    ]
    return scene(nodes, until=UNTIL, gravity=list(GRAVITY[:dimension]))


def in_series(**more):
    """Two springs with a massless node between them; `more` is of the first."""
    nodes = [pin(0), node(1, mass=0), node(2.5, mass=1)]
    springs = [spring(0, 1, 30, rest_length=1, **more), spring(1, 2, 60, rest_length=1)]
    return scene(nodes, springs, until=0.5)


class Tables(Programs):
    def verlet(self, more, path="orbit"):
        line = f"simulate --scene {path} --method verlet --step-size {STEP} --until {UNTIL} "
        return self.done(line + more)

    def untimed(self, ended):
        """The words on a run without the time that it took."""
        return ended.stdout.rsplit(", in ", 1)[0]

    def check_nodes(self, rows, t):
        """Holds nodes against x + v t + g t^2 / 2, by the roundings of 500 steps."""
        for row, m, x, v in zip(rows, MASSES, POSITIONS, VELOCITIES, strict=True):
            for axis, x, v, g in zip("xyz", x, v, GRAVITY):
                if axis in row:
                    self.near(row[axis], x + (v * t + g * t * t / 2 if m else 0), 1e-12)
                    self.near(row["v" + axis], v + g * t if m else 0, 1e-11)

    def test_tables_hold_all_nodes_and_energies_of_the_motion(self):
        for columns in "node,x,vx", "node,x,y,vx,vy", "node,x,y,z,vx,vy,vz":
            with self.subTest(columns):
                axes = columns.split(",v")[0].split(",")[1:]
                write("s.toml", falling(len(axes)))
                outputs = "--final f.csv --trajectory g.csv --energy e.csv --every 0.125"
                self.verlet(outputs + " --force", "s.toml")
                final, path = table("f.csv", columns), table("g.csv", "t," + columns)
                energies = table("e.csv", "t,kinetic,potential,total")
                self.assertEqual([row["node"] for row in final], [0, 1, 2])
                self.assertEqual([row["t"] for row in energies], [0, 0.125, 0.25, 0.375, 0.5])
                for sample, energy in enumerate(energies):
                    rows = path[3 * sample : 3 * sample + 3]
                    self.assertEqual({row.pop("t") for row in rows}, {energy["t"]})
                    self.check_nodes(rows, energy["t"])
                    moving = [
                        (m, row["v" + axis], g, row[axis])
                        for m, row in zip(MASSES, rows)
                        for axis, g in zip(axes if m else "", GRAVITY)
                    ]
                    kinetic = sum(m * v * v / 2 for m, v, _, _ in moving)
                    # Sums of a few terms up to 100 J.
                    self.near(energy["kinetic"], kinetic, 1e-10)
                    self.near(energy["potential"], -sum(m * g * x for m, _, g, x in moving), 1e-10)
                    self.assertEqual(energy["total"], energy["kinetic"] + energy["potential"])
                self.assertEqual((final, (final[1]["x"], final[1]["vx"])), (rows, (1.1, 0)))

    def test_each_output_has_the_every_behind_it_and_a_single_one_is_for_both(self):
        apart, together = (3, 6), (6, 6)
        for outputs, counts in (
            ("--trajectory g.csv --every 0.2 --energy e.csv --every 0.1", apart),
            ("--energy e.csv --every 0.1 --trajectory g.csv --every 0.2", apart),
            ("--trajectory g.csv --energy e.csv --every 0.1", together),
            ("--trajectory g.csv --every 0.1 --energy e.csv", together),
            ("--every 0.1 --trajectory g.csv --energy e.csv", together),
        ):
            self.verlet(outputs, "oscillator")
            self.assertEqual((len(table("g.csv")) / 2, len(table("e.csv"))), counts, outputs)
            self.assertEqual(table("e.csv")[-1]["t"], 0.5)
        self.verlet("--energy e.csv --every 0.2")  # which does not divide 0.5
        self.assertEqual([row["t"] for row in table("e.csv")], [0, 0.2, 0.4])

    def test_looking_at_a_run_does_not_change_where_it_ends(self):
        short = "pendulum --until 0.5 --step-size 0.001 --method "
        # The rounding of t alone is some 1e-9 of a step after 13 million of the last one's.
        long = "oscillator --until 66 --step-size 5e-6 --method verlet"
        for scene in (short + "verlet", short + "implicit_euler", short + "kahan_li8", long):
            line = f"simulate --force --final f.csv --scene {scene} "
            alone, end = self.done(line), read("f.csv")
            seen = self.done(line + "--trajectory g.csv --every 0.007 --energy e.csv --every 0.005")
            self.assertEqual((self.untimed(seen), read("f.csv")), (self.untimed(alone), end))

    def test_every_table_has_a_sidecar_that_says_where_it_comes_from(self):
        outputs = "--final f.csv --trajectory g.csv --every 0.1 --energy e.dat --every 0.2"
        ended = self.verlet(outputs)
        written = "e.dat e.dat.json f.csv f.json g.csv g.json"
        self.assertEqual(sorted(os.listdir(".")), written.split())
        for name in ("f.json", "g.json", "e.dat.json"):
            origin = sidecar(name)
            self.assertEqual(origin["command_line"], ended.args)
            self.assertRegex(origin["scene"]["hash"], "^[0-9a-f]{16}$")
            self.assertIsNone(origin["scene"]["stiff_above"])
            for value in (origin[key] for key in ("version", "compiler", "flags", "cpu")):
                self.assertTrue(value)
            for library in ("eigen", "sundials", "cholmod"):
                self.assertTrue(origin["libraries"][library])
            self.assertRegex(origin["date"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")

    def test_the_lists_name_everything(self):
        for kinds, name, count in (("methods", "name", 60), ("scenes", "parameter", 50)):
            rows = rows_of(self.done(f"simulate --list-{kinds} --csv").stdout)
            self.assertGreater(len(rows), count)
            said = "\n" + self.done(f"simulate --list-{kinds}").stdout
            for row in rows:
                self.holds(said, row[name], row["summary"])
                self.assertTrue(row.get("source", "of methods alone"))
                if kinds == "scenes":
                    line = f" {row['standard']:.15g}  {row['meaning']}\n"
                    self.holds(said, f"\n{row['scene']} ", line)

    def test_a_written_scene_moves_as_the_one_it_is_of(self):
        for more in ("", "--no-reduce mirror "):
            line = f"simulate --method verlet --step-size 5e-4 --until 0.01 {more}--force"
            first = self.done(f"{line} --scene cloth --write-scene s.toml --final a.csv")
            second = self.done(f"{line} --scene s.toml --final b.csv")
            self.assertEqual(read("a.csv"), read("b.csv"))
            self.assertEqual(self.untimed(first), self.untimed(second))
        written = read("s.toml")
        alone = self.done("simulate --scene cloth --write-scene alone.toml")  # without a run
        self.assertEqual((alone.stdout, alone.stderr), ("", ""))
        self.assertEqual(read("alone.toml").split("\n")[3:], written.split("\n")[3:])

    def test_inputs_are_never_replaced_and_files_of_others_by_force_alone(self):
        write("m.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")
        write("s.toml", "[mesh]\nfile = 'm.obj'\nstiffness = 1\nnode_mass = 1\n")
        line = "simulate --scene s.toml --method verlet --step-size 0.01 --until 0.1 "
        for place in ("s.toml", "m.obj"):
            for option in ("--final", "--write-scene"):
                for more in ("", " --force"):
                    self.refused(f"{line}{option} {place}{more}", place, "was read")
        write("end.json", "mine")
        self.refused(line + "--final end.csv", "end.json", "--force")
        self.assertEqual(read("end.json"), "mine")
        self.done(line + "--final end.csv --force")
        self.done(line + "--final end.csv")  # its own by now


class Scenes(Programs):
    def test_a_massless_node_is_for_methods_that_accept_it(self):
        # Two springs in series cannot be replaced by one if one of them is quartic.
        write("s.toml", in_series(quartic=1))
        line = "simulate --scene s.toml --final f.csv --step-size 0.01 --method "
        self.refused(line + "verlet", "s.toml", "nodes[1].mass: 0", "implicit_euler")
        said = self.done(line + "implicit_euler").stderr  # it damps, and that is all
        self.assertRegex(said, r"\Asimulate: warning: the method took [^\n]+\n\Z")

    def test_two_springs_in_series_are_one_while_in_tension(self):
        write("s.toml", in_series())
        # k = 20 N/m: a quarter of the period 2 pi sqrt(1/20) s, and 0.5 m of stretch, until it is
        # slack.
        slack = math.pi / 2 / math.sqrt(20)
        line = "simulate --scene s.toml --method verlet --step-size 0.01 --final f.csv"
        self.complains(line, 3, "of 0.5 s", "compression", "--no-reduce massless")
        self.assertEqual(sidecar("f.json")["outcome"], "went_slack")
        self.near(sidecar("f.json")["t_reached"], slack - 0.01, 0.01)
        self.done(line + " --until 0.3")
        _, massless, tip = table("f.csv")
        # Verlet's error at h w < 0.05 is below (h w)^2 w t / 24.
        self.near(tip["x"], 2 + 0.5 * math.cos(math.sqrt(20) * 0.3), 2e-4)
        self.near(30 * (massless["x"] - 1) / (60 * (tip["x"] - massless["x"] - 1)), 1, 1e-12)
        self.near(30 * massless["vx"] / (60 * (tip["vx"] - massless["vx"])), 1, 1e-12)

    def test_a_scene_that_starts_at_equilibrium_does(self):
        facts = {"gravity": [0, -10], "until": 0.5, "start": "equilibrium"}
        write("s.toml", scene([pin(0, 0), node(0.6, 0.8, mass=1)], [spring(0, 1, 100)], **facts))
        self.done("simulate --scene s.toml --method verlet --step-size 1e-3 --final f.csv")
        end = table("f.csv")[1]
        # Hanging, 0.1 m longer, to what rounding leaves of the residual.
        for name, value in ("x", 0), ("y", -1.1), ("vy", 0):
            self.near(end[name], value, 1e-9)

    def test_reductions_are_explained_without_a_run_and_can_be_left_out(self):
        # The chain: 100 nodes, one pinned, in a plane. The cloth: 900, two pinned, one half; its
        # lower half without the mirror.
        for drawn, without, unknowns in (
            ("chain", "", "198 unknowns of 300"), ("chain", "dimension", "297 unknowns of 300"),
            ("chain", "pins", "200 unknowns of 300"), ("chain", "pins,dimension", "300 unknowns"),
            ("cloth", "", "1347 unknowns of 2700"), ("cloth", "mirror", "2694 unknowns of 2700"),
            ("cloth", "mirror,pins", "2700 unknowns"),
        ):  # fmt: skip
            left_out = f" --no-reduce {without}" if without else ""
            said = self.done(f"simulate --scene {drawn} --explain{left_out}").stdout
            self.holds(said, unknowns, "w_max", "2/w_max")
            self.assertEqual("mirror" in said, drawn == "cloth" and not without, said)
            if (drawn, without) == ("cloth", ""):
                self.holds(said, "pins", "x = 0.5", "449 of 898", "no direction grows")

    def test_a_small_motion_is_linear_unless_that_is_forbidden(self):
        drawn = write(
            "small_pluck.toml",
            'until = 2.0\n[generator]\nkind = "plucked_string"\nnodes = 12\nlength = 1\n'
            "stiffness = 1e5\nheight = 1e-7\n",
        )
        asked = f"simulate --scene {drawn} --accuracy 1e-3 --final end.csv"
        self.assertIn("left out: the motion is linear here", self.done(asked).stdout)
        linear, origin = table("end.csv"), sidecar("end.json")
        self.assertEqual(origin["method"], "exact")
        self.assertEqual(origin["error_estimate_kind"], "neglected")
        self.assertLessEqual(origin["linear"]["change"], 5e-4)
        kept = self.done(f"{asked} --no-reduce linear").stdout
        self.assertNotIn("left out", kept)
        for one, other in zip(linear, table("end.csv")):
            # Displacements are up to a tenth of a micrometre.
            self.assertLess(abs(float(one["z"]) - float(other["z"])), 2e-3 * 1e-7)

    def test_options_reach_the_methods_that_take_them(self):
        line = "simulate --scene orbit --until 0.1 --method "
        for more in (
            "ida --rtol 1e-3 --max-order 5",
            "cvode_adams --rtol 1e-3 --max-order 12",
            "ida --rtol 1e-3 --max-order 77 --max-order 2",  # given twice the last counts
            "cvode_bdf --rtol 1e-3 --stability-detection",
            "implicit_euler --step-size 1e-3 --solve-tolerance 1e-8",
            "generalized_alpha --step-size 1e-3 --spectral-radius 1",
            "implicit_euler --step-size 1e-3 --solver conjugate_gradients",
            "ida --rtol 1e-3 --solver cholmod",
        ):
            self.done(line + more)
        cloth = "simulate --scene cloth --method local_global --step-size 0.01 --until 0.02"
        for more, said in (" --iterations 3", "6 force and 0 stiffness"), ("", "20 force"):
            self.holds(self.done(cloth + more).stdout, said)


class Warnings(Programs):
    """Sentences beside a run that goes on, and on one that fails."""

    def test_each_is_said_where_it_is_so(self):
        grows = f"{math.log(2) / (2 * 0.1):.3g}/s"  # sqrt(1 + h^2 w^2) a step of 0.1 s
        for words, status, *fragments in (
            # Tolerances that hardly mean anything.
            ("ida --until 0.01 --rtol 0.1 --atol 1e-6", 0),
            ("ida --until 0.01 --rtol 0.2 --atol 1e-6", 0, "--rtol 0.2", "hardly"),
            ("ida --until 0.01 --rtol 1e-15 --atol 1e-6", 0, "--rtol 1e-15", "rounding"),
            ("ida --until 0.01 --rtol 1e-6 --atol 2", 0, "--atol 2", "positions, 1 m"),
            # Steps beyond the stable one, with both numbers.
            ("verlet --step-size 0.199 --until 1", 0, "verlet damps no vibration"),
            ("verlet --step-size 0.201 --until 1", 0, "h = 0.201 s", "2/w_max = 0.2 s"),
            ("kahan_li8 --step-size 0.308 --until 1", 0),
            ("kahan_li8 --step-size 0.312 --until 1", 0, "3.0964/w_max = 0.3096 s"),
            ("rk4 --step-size 0.28", 0, "rk4 damps like a damping ratio of"),
            ("rk4 --step-size 0.3", 0, "2.8284/w_max"),
            ("implicit_euler --step-size 0.5 --until 1", 0, " J, ", "% of the energy", "tried at this step: implicit_midpoint"),
            ("exact --step-size 0.5 --until 1", 0),
            ("explicit_euler --step-size 0.01", 0, "grow at every h", "0.5/s"),
            ("cvode_bdf --until 30 --rtol 1e-6", 0),
            ("cvode_adams --until 30 --rtol 1e-6", 0),
            ("cvode_bdf --until 30 --rtol 1e-2", 0, "the energy grew to", "lower --rtol"),
            ("cvode_adams --until 30 --rtol 1e-2", 0, "the energy grew to", "lower --rtol"),
            # One sentence says all of a run that fails.
            ("verlet --step-size 1 --until 200", 3, "grew without bound", "2/w_max = 0.2 s"),
            ("explicit_euler --step-size 0.1 --until 100", 3, "vibrations grow at every h", grows),
        ):  # fmt: skip
            with self.subTest(words):
                ended = run(OSCILLATOR + words + " --final f.csv")
                self.assertEqual((ended.returncode, ended.stderr == ""), (status, not fragments))
                self.holds(ended.stderr, *fragments)
                if status == 0:
                    self.assertRegex(ended.stderr, r"\A(simulate: warning: [^\n]+\n)*\Z")
                else:
                    self.complains(ended, 3)
                if "the energy grew to" in fragments:
                    self.assertGreater(sidecar("f.json")["energy_growth"], 10)
                if words.startswith("explicit_euler"):  # no step holds
                    self.assertNotIn("tried: h = ", ended.stderr)

    def number_behind(self, words, text):
        return float(re.search(words + r"([0-9.e+-]*[0-9])", text)[1])

    def test_a_step_above_the_limit_is_named_with_one_that_holds(self):
        line = OSCILLATOR + "verlet --until 100 --final f.csv --energy e.csv --every 1 --step-size "
        said = self.complains(
            line + "0.25", 3, "it failed in step", "h w_max is 2.5 at the start",
            "verlet's limit of 2", "smaller step", "at this h ", "implicit_euler",
        ).stderr  # fmt: skip
        # The end that was reached is there, with all samples before it.
        reached = sidecar("f.json")["t_reached"]
        self.assertEqual(sidecar("f.json")["outcome"], "diverged")
        self.assertIn(f"{reached:g} of 100 s", said)
        self.assertGreater(abs(table("f.csv")[1]["vx"]), 1e20)
        self.assertEqual(len(table("e.csv")), math.floor(reached) + 1)
        h = self.number_behind("stable when tried: h = ", said)
        self.assertEqual(h, 0.125)
        self.done(line + str(h))

    def test_the_step_it_failed_in_is_the_one_after_the_last_that_was_taken(self):
        # rho = 7 + sqrt(48) at h w = 4, and |v| = 10 grows to 1e30: 30 ln 10 / ln rho = 26.
        ended = run(OSCILLATOR + "verlet --step-size 0.4 --until 100")
        failed = self.number_behind("it failed in step ", ended.stderr)
        self.assertIn(failed, range(25, 29))
        self.assertIn(f"after {failed - 1:.0f} steps", ended.stdout)
        # The same oscillator, beside one that takes as many steps to nobody's harm.
        moving = {"velocity": [1], "mass": 1}
        nodes = [pin(0), node(1, **moving), pin(10), node(11, **moving)]
        write("two.toml", scene(nodes, [spring(0, 1, 1), spring(2, 3, 100)], until=100))
        ended = run("simulate --scene two.toml --method verlet --step-size 0.4")
        self.assertEqual(ended.returncode, 3)
        self.assertIn(self.number_behind("it failed in step ", ended.stderr), range(25, 29))

    def test_why_scenes_of_other_kinds_fail(self):
        write("large.toml", "[generator]\nkind = 'cloth'\nnodes = 80\n")  # 9597 unknowns
        self.complains(
            "simulate --scene large.toml --method verlet --step-size 0.01 --until 1", 3,
            "h w_max is at least ", "verlet's limit of 2",
        )  # fmt: skip
        # Numbers beyond all measure are no instability.
        for rest_length in (1e30, 1e200):
            springs = [spring(0, 1, 100, rest_length=rest_length)]
            write("long.toml", scene([pin(0, 0), node(1, 0, mass=1)], springs, until=1))
            line = "simulate --scene long.toml --method verlet --step-size 0.01"
            ended = self.complains(line, 3, "extreme rest lengths")
            self.assertNotIn("instability", ended.stderr)
        # The motion goes from rest length at 3 m/s to the stretch s where c/4 s^4 is nearly 9/2.
        # w^2 = 100 + 3 c s^2 grows from 10^2 to 66^2, so that h w_max = 0.4 at the start and 2.6 at
        # most.
        nodes = [pin(0), node(1, velocity=[3], mass=1)]
        write("stiffening.toml", scene(nodes, [spring(0, 1, 100, quartic=100000)], until=50))
        ended = self.complains(
            "simulate --scene stiffening.toml --method verlet --step-size 0.04", 3,
            "at t = ", "above verlet's limit of 2",
        )  # fmt: skip
        self.assertGreater(self.number_behind("h w_max is ", ended.stderr), 2)

    def test_newton_that_fails_names_a_step_at_which_it_does_not(self):
        line = "simulate --scene pendulum --method discrete_gradient --step-size "
        ended = self.complains(line + "0.5", 3, "it failed in step 2", "stable when tried: h = ")
        self.done(line + str(self.number_behind("stable when tried: h = ", ended.stderr)))

    def test_a_long_run_says_how_long_it_will_take(self):
        # 2e11 steps, minutes at the very least.
        line = "simulate --scene pendulum --method verlet --step-size 1e-11 --time-limit 2.5"
        ended = run(line)
        self.assertEqual(ended.returncode, 3)
        self.holds(ended.stderr, "simulate: t = ", "the run will take about ")
