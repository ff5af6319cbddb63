"""Studies of methods: their tables, and closed forms of the numbers there."""

import math
import os

from programs import (
    CHAOS, Programs, header, node, pin, scene, sidecar, spring, study, table, write,
)  # fmt: skip

# n masses of 1 kg on springs of 100 N/m between two walls in 1D, at rest:
# w_j = 20 sin(j pi / (2 (n + 1))) rad/s.
ROW = 30


def row(n):
    nodes = [pin(0), *(node(i, mass=1) for i in range(1, n + 1)), pin(n + 1)]
    return scene(nodes, [spring(i, i + 1, 100) for i in range(n + 1)])


FILES = {"row.toml": row(ROW)}
CONVERGENCE = (
    "convergence --scene pendulum --until 1 --methods verlet,blanes_moan6,kahan_li8 --out out"
)
REVERSAL = (
    "reversal --scene pendulum --until 1 --steps 0.01,0.005 --methods verlet,rk4,implicit_euler"
    " --out out"
)
MODES = "modes --scene row.toml --count 4 --out out"
DRIFT = (
    "energy_drift --scene orbit --step-size 0.02 --until 400 --rtol 1e-4,1e-6"
    " --methods verlet,rk4,implicit_euler,explicit_euler,cvode_adams --out out"
)
# The chain for 60 s, in which I_1 falls to half, by four methods. One is right, one is too slow at
# steps far above its accuracy, one is unstable there, and one damps.
EXCHANGE = (
    "exchange --scene fpu --until 60 --methods verlet,implicit_midpoint,rodas4,implicit_euler"
    " --h-omega 0.1,2.25 --out out"
)
MAP = (
    "stability_map --scene oscillator --amplitudes 1 --low 1 --high 4 --columns 3 --out out"
    " --methods verlet,implicit_euler,ida,explicit_euler,trapezoidal"
)
VERDICTS = "verdicts --seeds 3 --cells 512 --out out"
ROOTS = "symmetric_roots --samples 6 --at 0.5 --out out"

# The headers of each study's tables (or how they begin), and words that it says.
TABLES = {
    CONVERGENCE: (
        {"order": "method,h,error_position,error_velocity,observed_order"},
        ("divided by the largest displacement", "-: no order"),
    ),
    REVERSAL: ({"reversal": "method,"}, ()),
    MODES: (
        {"modes": "mode,omega,frequency_hz", "shapes": "mode,node,x,dx", "springs": "i,j"},
        ("row as drawn", "unstable: 0", "w_max", "Lanczos", "Gershgorin", "2/w_max"),
    ),
    DRIFT: (
        {
            "drift": "method,t,energy,relative_error,knob,value",
            "summary": "method,outcome,drift_rate,drift_rate_low,drift_rate_high,oscillation,"
            "verdict,knob,value,",
            "tolerance": "method,rtol,periods,outcome,drift_rate,drift_rate_low,drift_rate_high,"
            "energy_error_end,steps,time_s",
        },
        ("verlet", "cvode_adams 1e-06", "goes as rtol^"),
    ),
    EXCHANGE: (
        {
            "exchange": "method,h,h_omega,t,spring,energy",
            "summary": "method,h,h_omega,outcome,t_reached,steps,force_evaluations,sum_deviation,"
            "energy_error,exchange_error,tempo,misfit,verdict",
        },
        ("rodas4 is left out: it chooses its steps",),
    ),
    MAP: (
        {
            "map": "method,h,h_omega,amplitude,outcome,growth_rate,predicted_growth_rate",
            "limits": "method,h_limit_predicted,h_limit_measured",
            "linear": "method,", "modal": "method,", "adaptive": "method,",
            "damped_limits": "method,damping_ratio,h_omega_limit_predicted",
        },
        ("verlet", "none"),
    ),
    VERDICTS: (
        {
            "confusion": "kind,verdict,count,part,judgement",
            "coverage": "kind,what,said,held,part,part_low,part_high",
        },
        (),
    ),
    ROOTS: (
        {"roots": "steps,method,cosines,limit,phase_error,gap,energy_swing"},
        ("symmetric4", "symmetric10", "k = 12: largest limit", "with a gap below 0.2"),
    ),
}  # fmt: skip


def made(line):
    return study(line, *FILES.items())


class Tables(Programs):
    def test_each_study_writes_its_tables_with_their_sidecars_and_nothing_else(self):
        for line, (headers, words) in TABLES.items():
            with self.subTest(line):
                done = made(line)
                written = sorted(f"{name}.{end}" for name in headers for end in ("csv", "json"))
                there = set(os.listdir(done / "out")) - {"reference.json"}
                self.assertEqual(sorted(there), written)
                self.assertEqual(sorted(os.listdir(done.path)), sorted(["out", *FILES]))
                self.holds(done.out, *words)
                for name, columns in headers.items():
                    self.assertTrue(header(done / f"out/{name}.csv").startswith(columns))
                    done.table(f"out/{name}.csv")
                    origin = done.sidecar(f"out/{name}.json")
                    for key in ("command_line", "version", "compiler", "cpu", "libraries", "date"):
                        self.assertTrue(origin[key])


class Orders(Programs):
    def test_every_order_that_is_told_is_the_methods(self):
        rows = made(CONVERGENCE).table("out/order.csv")
        self.assertGreater(min(one["error_position"] for one in rows), 0)
        told = [one for one in rows if one["observed_order"]]
        self.assertEqual(made(CONVERGENCE).sidecar("out/order.json")["reduced"]["unknowns"], 3)
        self.assertGreaterEqual(len(told), 8)
        orders = {"verlet": 2, "blanes_moan6": 6, "kahan_li8": 8}
        for one in told:
            # The next term of the error has two powers of h more and, at the coarsest, is some
            # tenths.
            self.near(one["observed_order"], orders[one["method"]], 0.75)

    def test_beyond_the_horizon_there_are_no_errors_and_no_orders(self):
        write("chain.toml", CHAOS)
        ended = self.done("convergence --scene chain.toml --methods verlet,kahan_li8 --out out")
        self.holds(ended.stdout, "chaotic", "nobody knows the positions")
        rows = table("out/order.csv")
        self.assertEqual([one["method"] for one in rows], ["verlet", "kahan_li8"])
        for column in ("error_position", "error_velocity", "observed_order"):
            self.assertEqual([one[column] for one in rows], [None, None])

    def test_symmetric_methods_return_and_others_as_near_as_their_order_says(self):
        verlet, _, *others = made(REVERSAL).table("out/reversal.csv")
        self.assertLess(verlet["distance"], 1e-12)  # rounding of some hundred steps
        for coarse, fine in (others[:2], others[2:]):
            # The error of rk4 on the way there is undone on the way back, but for its next term.
            order = 5 if coarse["method"] == "rk4" else 1
            self.near(math.log2(coarse["distance"] / fine["distance"]), order, 0.3)
        self.done("reversal --scene cloth --until 0.05 --methods verlet --steps 1e-3 --out out")
        self.assertIsNone(table("out/reversal.csv")[0]["distance"])  # it did not reach its end

    def test_every_study_takes_a_scene_without_unknowns(self):
        write("s.toml", scene([pin(0), pin(1)], [spring(0, 1, 10)], until=0.5))
        for words in (
            "work_precision --methods verlet,ida --repeats 1", "convergence --methods verlet",
            "energy_drift --methods verlet --step-size 0.1", "stability_map --methods verlet",
            "stock_sundials --methods ida", "reversal --methods verlet", "modes", "motions",
        ):  # fmt: skip
            self.done(f"{words} --scene s.toml --out out")
        self.assertEqual(table("out/reversal.csv")[0]["distance"], 0)


class Rest(Programs):
    """Equilibria and the vibrations about them."""

    def test_nodes_at_rest_are_written_as_simulate_writes_them(self):
        # The pendulum hangs longer by its weight over its stiffness.
        for drawn, columns, end in (
            ("oscillator", "node,x,vx", {"node": 1, "x": 0, "vx": 0}),
            ("pendulum", "node,x,y,z,vx,vy,vz", {"z": -1 - 9.81 / 1000, "vx": 0, "vz": 0}),
            ("lattice", "node,x,y,z,vx,vy,vz", {"vx": 0}),
        ):
            ended = self.done(f"equilibrium --scene {drawn} --final e.csv")
            self.assertEqual((header("e.csv"), ended.stderr), (columns, ""))
            for name, value in end.items():
                self.near(table("e.csv")[1][name], value, 1e-12)
            self.holds(ended.stdout, drawn, "largest force", "energy", "isolated minimum")
            origin = sidecar("e.json")
            self.assertEqual((origin["outcome"], origin["isolated"]), ("reached", True))
            smallest = f"{origin['smallest_eigenvalue']:.6g} N/m"
            self.holds(ended.stdout, "smallest eigenvalue of -K", smallest)
            self.assertLess(origin["residual"], 1e-9)
            if drawn == "pendulum":  # sideways m g / l
                self.near(origin["smallest_eigenvalue"], 9.81 / (1 + 9.81 / 1000), 1e-12)

    def test_a_shape_is_the_nodes_as_drawn_and_how_far_they_move(self):
        self.done("equilibrium --scene pendulum --out out")
        (_, bob), (spring,) = table("out/shape.csv"), table("out/springs.csv")
        self.near(bob["z"] + bob["dz"], -1 - 9.81 / 1000, 1e-12)
        self.near(bob["x"] + bob["dx"], 0, 1e-9)
        self.assertEqual((spring["i"], spring["j"]), (0, 1))
        self.assertEqual(sidecar("out/shape.json")["outcome"], "reached")

    def test_scenes_that_are_loose_or_never_rest(self):
        # Six motions of a free body in space, less the turn of two points about their line.
        free = self.done("equilibrium --scene pair").stdout
        self.holds(free, "5 directions", "moves and turns as a whole")
        # A node between two pins, on springs at rest length: it gives way to the side, and turning
        # about the line of the pins is only one of these two directions.
        nodes = [pin(0, 0, 0), node(1, 0, 0, mass=1), pin(2, 0, 0)]
        write("slack.toml", scene(nodes, [spring(0, 1, 1), spring(1, 2, 1)]))
        slack = self.done("equilibrium --scene slack.toml").stdout
        self.holds(slack, "2 directions", "1 of them", "something is loose", "not known to be isolated")
        write("falling.toml", scene([node(0, mass=1)], gravity=[-1]))
        line = "equilibrium --scene falling.toml --final e.csv"
        self.complains(line, 3, "no equilibrium", "falls for ever (node 0 moved by ")
        origin = sidecar("e.json")
        self.assertEqual((origin["outcome"], origin["residual"]), ("unbounded", 1))
        self.done("modes --scene falling.toml --out out")

    def test_both_ends_of_the_spectrum_have_their_closed_forms(self):
        done = made(MODES)
        rows = done.table("out/modes.csv")
        self.assertEqual([one["mode"] for one in rows], [1, 2, 3, 4, 27, 28, 29, 30])
        for one in rows:
            w = 20 * math.sin(one["mode"] * math.pi / (2 * (ROW + 1)))
            # w^2 is right to 1e-13 of 400 / s^2.
            self.near(one["omega"], w, 4e-11 / w)
            self.near(one["frequency_hz"], w / (2 * math.pi), 4e-11 / w)
        # Shapes of the lowest only, sines of all nodes with unit generalised mass.
        shapes = done.table("out/shapes.csv")
        self.assertEqual(len(shapes), 4 * (ROW + 2))
        for one in shapes:
            self.assertEqual(one["x"], one["node"])
            sine = math.sin(one["mode"] * one["node"] * math.pi / (ROW + 1))
            self.near(abs(one["dx"]), abs(sine) * math.sqrt(2 / (ROW + 1)), 1e-9)
        ends = [one["j"] for one in done.table("out/springs.csv")]
        self.assertEqual(ends, list(range(1, ROW + 2)))
        self.assertEqual(done.sidecar("out/modes.json")["finite_modes"], ROW)
        self.assertEqual(done.sidecar("out/modes.json")["at"], "drawn")

    def test_few_modes_are_all_tabulated(self):
        write("row.toml", row(5))
        for count, modes in (2, 4), (3, 5), (4, 5), (10, 5):
            self.done(f"modes --scene row.toml --count {count} --out out")
            self.assertEqual(table("out/modes.csv")[-1]["mode"], 5)
            self.assertEqual(len(table("out/modes.csv")), modes)
            self.assertEqual(len(table("out/shapes.csv")), 7 * min(count, 5))

    def test_growth_soft_modes_and_zeros(self):
        # A mass on a spring that its weight compresses: w^2 = -g/l sideways and k/m along.
        nodes, springs = [pin(0, 0), node(0, 0.9, mass=1)], [spring(0, 1, 100, rest_length=1)]
        write("upright.toml", scene(nodes, springs, gravity=[0, -10]))
        # It stands on a stiff spring: w^2 = -g/l to the rounding of k, 1e-15 of 1e11 / s^2.
        stiff = spring(0, 1, 1e9, rest_length=1 + 1e-10)
        write("stands.toml", scene([pin(0, 0), node(0, 1, mass=0.01)], [stiff], gravity=[0, -10]))
        # The second mass on its spring of 0.001 N/m, whose other end gives way by 1e-12 of it.
        nodes = [pin(0), node(1, mass=1), node(2, mass=1)]
        write("soft.toml", scene(nodes, [spring(0, 1, 1e9), spring(1, 2, 0.001)]))
        for words, said, omegas, tolerance in (
            ("upright.toml", "unstable: 1", [-math.sqrt(10 / 0.9), 10], 1e-12),
            ("upright.toml --at equilibrium", "unstable: 0", [math.sqrt(10 / 1.1)], 1e-12),
            ("stands.toml", "unstable: 1", [-math.sqrt(10)], 1e-4),
            ("soft.toml", "unstable: 0", [math.sqrt(0.001)], 3e-13),
            ("pair", "unstable: 0", [0, 0, 0], 0),  # translations
        ):
            ended = self.done(f"modes --scene {words} --out out")
            self.holds(ended.stdout, said, f"zero within rounding: {omegas.count(0)}")
            self.assertEqual("at equilibrium" in ended.stdout, words.endswith("equilibrium"))
            self.assertEqual("grows" in ended.stdout, omegas[0] < 0, words)
            for one, omega in zip(table("out/modes.csv"), omegas):
                self.near(one["omega"], omega, tolerance)
                self.near(one["frequency_hz"], omega / (2 * math.pi), tolerance)
        ended = self.done("equilibrium --scene soft.toml")
        self.holds(ended.stdout, "0.001 N/m", "an isolated minimum")

    def test_a_massless_node_that_nothing_holds_has_no_modes(self):
        nodes = [pin(0, 0), node(1, 0, mass=0), node(2, 0, mass=1, velocity=[1, 0])]
        write("loose.toml", scene(nodes, [spring(0, 1, 100), spring(1, 2, 100)], until=1))
        for line in ("modes --scene loose.toml", "stability_map --scene loose.toml --methods ida"):
            self.complains(f"{line} --out out", 3, "massless node")


class Energies(Programs):
    def test_each_run_has_its_path_and_its_verdict(self):
        done = made(DRIFT)
        summary = done.table("out/summary.csv")
        methods = "verlet rk4 implicit_euler explicit_euler cvode_adams cvode_adams".split()
        self.assertEqual([one["method"] for one in summary], methods)
        for one in summary:
            low, high = one["drift_rate_low"], one["drift_rate_high"]
            self.assertTrue(low <= one["drift_rate"] <= high)
            self.assertEqual("no drift" in one["verdict"], low <= 0 <= high)
        verlet, rk4, implicit, explicit = summary[:4]
        self.holds(verlet["verdict"], "bounded", "no drift")
        self.assertLess(rk4["drift_rate_high"], 0)
        self.assertIn("dissipates", implicit["verdict"])
        self.assertLess(implicit["drift_rate_high"], 0)
        self.assertIn("blows up at t = ", explicit["verdict"])
        self.assertEqual(explicit["outcome"], "diverged")
        self.assertGreater(explicit["drift_rate_low"], 0)

        scale = done.sidecar("out/drift.json")["energy_scale"]
        last = {"t": math.inf}
        for one in done.table("out/drift.csv"):
            if one["t"] == 0:
                start = one["energy"]
                self.near(start, 4.5 + 2, 1e-13)  # m v^2/2 + k (r - l0)^2/2
            else:
                self.assertGreater(one["t"], last["t"])
                self.assertEqual(one["value"], last["value"])
            last = one
            error = (one["energy"] - start) / scale
            # The error follows from the energy, up to rounding.
            self.near(one["relative_error"], error, 1e-14 * (1 + abs(error)))

        coarse, fine = done.table("out/tolerance.csv")
        self.assertEqual(coarse["rtol"], 1e-4)
        self.assertLess(abs(fine["energy_error_end"]), 0.1 * abs(coarse["energy_error_end"]))

    def test_step_and_horizon_have_defaults(self):
        self.done("energy_drift --scene oscillator --methods symplectic_euler --out out")
        (one,) = table("out/summary.csv")
        self.near(one["value"], 0.05, 1e-12)  # h w = 1/2
        self.assertEqual(one["steps"], 1e6)
        self.holds(one["verdict"], "bounded", "no drift")

    def test_what_drifts_is_the_method_and_not_what_its_solves_leave(self):
        rates = []
        for more in ("", "--solve-tolerance 0.0001", "--solve-tolerance 1e-12"):
            self.done(
                "energy_drift --scene orbit --until 5000 --methods trapezoidal,generalized_alpha"
                f" --method-limit 1000 --out out {more}"
            )
            gain, loss = table("out/summary.csv")
            rates.append((gain["drift_rate_low"], loss["drift_rate"]))
        (gain, loss), (loose_gain, loose_loss), (tight_gain, tight_loss) = rates
        # The trapezoidal rule is conjugate to a symplectic method and bounded.
        self.assertLess(max(gain, tight_gain), 0)
        self.assertGreater(loose_gain, 0)
        # 1e-9 is worth 3e-7 of the loss, 1e-4 a third of it.
        self.near(loss / tight_loss, 1, 1e-5)
        self.assertGreater(loose_loss, 0.8 * tight_loss)

    def test_compensation_and_massless_nodes_are_for_those_that_take_them(self):
        line = "energy_drift --scene orbit --until 100 --methods verlet,rk4 --compensated --out out"
        self.done(line)
        self.assertEqual([one["compensated"] for one in table("out/summary.csv")], ["yes", "no"])
        nodes = [pin(0, 0), pin(2, 0), node(1, 0, mass=0), node(1, -1, mass=1)]
        springs = [spring(i, 2, 100, rest_length=0.9) for i in (0, 1)]
        write("joint.toml", scene(nodes, [*springs, spring(2, 3, 50)], gravity=[0, -9.81]))
        line = "energy_drift --scene joint.toml --methods bdf2,implicit_euler --until 20 --out joint"
        self.done(line)
        self.assertIn("dissipates", table("joint/summary.csv")[1]["verdict"])

    def test_verdicts_are_seldom_wrong_and_intervals_hold_what_is_true(self):
        done = made(VERDICTS)
        confusion = done.table("out/confusion.csv")
        kinds = {one["kind"] for one in confusion}

        def count(**wanted):
            rows = (one for one in confusion if wanted.items() <= one.items())
            return sum(one["count"] for one in rows)

        self.assertTrue(all(count(kind=kind) == 3 for kind in kinds))
        # One in twenty may be wrong: more than 11 of a hundred are, once in 250 times.
        self.assertGreater(count(), 100)
        self.assertLessEqual(count(judgement="wrong"), 11)
        for kind in (  # each is told nearly always
            "noise", "sine, period T/4", "large drift over noise", "loss of a third, exponential",
            "loss of 0.3 in the first fifth", "amplitude that grows as t", "blow-up",
            "round-off walk",
        ):  # fmt: skip
            self.assertGreaterEqual(count(kind=kind, judgement="right"), 2, kind)
        # And a walk is never claimed to be anything.
        self.assertEqual(count(kind="random walk", judgement="right"), 0)
        coverage = done.table("out/coverage.csv")
        self.assertTrue(all(one["part_low"] <= one["part"] for one in coverage))
        said, held = (sum(one[name] for one in coverage) for name in ("said", "held"))
        # Fewer than 134 of 150 that hold by 95 % come once in 300 times; there are more.
        self.assertGreater(said, 150)
        self.assertGreater(held, 0.89 * said)
        self.assertEqual(done.sidecar("out/confusion.json")["seeds"], 3)
        self.assertIn("random walk", done.sidecar("out/confusion.json")["walk_size"])


class Exchanges(Programs):
    def test_energies_are_tabulated_by_method_step_time_and_spring(self):
        last, total, starts = {}, 0, 0
        for number, one in enumerate(made(EXCHANGE).table("out/exchange.csv")):
            spring, energy, t, h = (one[name] for name in ("spring", "energy", "t", "h"))
            self.assertEqual(spring, (0, 1, 2, "sum")[number % 4])
            self.near(h * 50, one["h_omega"], 1e-12)  # w to rounding
            self.near(t / h, round(t / h), 1e-8)  # whole steps
            if t == 0:
                starts += 1
                # The chain's positions of up to 70 m are right to 2e-14 m, k = 1250 N/m on 0.03 m.
                self.near(energy, spring in (0, "sum"), 1e-12)
            if spring == "sum":
                self.near(energy, total, 1e-12 * energy)
            total = 0 if spring == "sum" else total + energy
            last[one["method"], one["h_omega"]] = t
        # Four numbers of each of three methods of two steps, and of the reference.
        self.assertEqual((len(last), starts), (7, 28))
        # Within a sample, some 0.06 s, of the end, but for the one that blows up.
        for which, t in last.items():
            self.assertEqual(t > 59.9, which != ("verlet", 2.25))

    def test_each_method_has_its_verdict(self):
        done = made(EXCHANGE)
        rows = {(one["method"], one["h_omega"]): one for one in done.table("out/summary.csv")}
        self.assertEqual(len(rows), 7)
        for method in ("reference", "verlet", "implicit_midpoint"):
            self.assertEqual(rows[method, 0.1]["verdict"], "exchanges as it should")
        unstable, slow = rows["verlet", 2.25], rows["implicit_midpoint", 2.25]
        self.assertTrue(unstable["verdict"].startswith("blows up at t = "))  # beyond h w = 2
        self.assertEqual((unstable["outcome"], unstable["tempo"]), ("diverged", None))
        self.assertLess(unstable["t_reached"], 1)
        # It sees the vibrations at a lower frequency, (2/h) atan(h w/2).
        self.assertIn("times too slowly", slow["verdict"])
        self.assertLess(slow["tempo"], 0.5)
        self.assertLess(slow["misfit"], 0.1)
        for h_omega in (0.1, 2.25):
            self.assertEqual(rows["implicit_euler", h_omega]["verdict"], "damps: nothing left")
        self.assertGreater(rows["implicit_euler", 0.1]["sum_deviation"], 0.99)
        # The exact motion changes the sum by 0.06 for moments, and H not at all.
        self.assertLess(rows["reference", 0.1]["sum_deviation"], 0.07)
        self.assertLess(rows["verlet", 0.1]["sum_deviation"], 0.08)
        self.assertLess(rows["reference", 0.1]["energy_error"], 1e-9)
        # (h w)^2 / 8 of the vibrations' energy, half of H: Verlet keeps 1/2 v^2 + 1/2 w^2 x^2
        # (1 - (h w)^2/4) of them.
        self.assertTrue(1e-4 < rows["verlet", 0.1]["energy_error"] < 1.5e-3)
        self.assertEqual(rows["verlet", 0.1]["steps"], 30000)
        origin = done.sidecar("out/summary.json")
        self.near(origin["omega"], 50, 1e-11)
        self.assertEqual(origin["until"], 60)
        self.assertLess(origin["certified"], 1e-6)
        self.near(origin["window"] / (40 * 2 * math.pi / 50), 1, 1e-12)

    def test_springs_of_several_parts_are_followed_and_the_fastest_part_sets_w(self):
        # Two chains side by side. The second is softer and has no energy, so that it rests.
        nodes = [node(0, mass=2), node(1.1, mass=2), node(10, mass=1), pin(11)]
        springs = [spring(0, 1, 400, rest_length=1), spring(2, 3, 100, rest_length=1)]
        write("two.toml", scene(nodes, springs, until=10, stiff_above=50))
        self.done("exchange --scene two.toml --methods verlet --h-omega 0.5 --out out")
        self.near(sidecar("out/summary.json")["omega"], 20, 1e-11)  # sqrt(400 / 1) against 10
        self.assertEqual(table("out/summary.csv")[1]["verdict"], "as it should: no exchange so far")
        for one in table("out/exchange.csv"):
            # 1/2 400 0.1^2, which Verlet keeps to (h w)^2/4 = 1/16.
            if one["spring"] == 0:
                self.near(one["energy"], 2, 0.13)
            if one["spring"] == 1:
                self.assertLess(one["energy"], 1e-20)


class Stability(Programs):
    def map(self, words):
        return self.done("stability_map --out out " + words)

    def test_limits_are_predicted_and_measured_in_seconds(self):
        methods = "explicit_euler,verlet,rk4,implicit_euler"
        ended = self.map(f"--scene oscillator --amplitudes 1 --methods {methods} --columns 3")
        euler, verlet, rk4, implicit = table("out/limits.csv")
        self.assertEqual(euler["h_limit_measured"], 0)
        for one, limit in (verlet, 0.2), (rk4, math.sqrt(8) / 10):
            self.near(one["h_limit_predicted"] / limit, 1, 1e-12)
            self.near(one["h_limit_measured"] / limit, 1, 1e-8)
            self.near(one["relative_difference"], 0, 1e-8)
        for name in ("h_limit_predicted", "h_limit_measured"):
            self.assertIsNone(implicit[name])
        self.holds(ended.stdout, "verlet", "2.828427125", "grows at every h", "none")

    def test_the_map_has_a_row_for_each_run_and_theory_beside_it(self):
        rows = made(MAP).table("out/map.csv")
        self.assertEqual(len(rows), 15)  # 3 of each, ida's at its tolerances
        for one, h_omega in zip(rows, (1, 2, 4)):
            self.near(one["h_omega"] / h_omega, 1, 1e-14)
            self.near(one["h"] / h_omega, 0.1, 1e-15)
            self.assertEqual(one["outcome"], "diverged" if h_omega == 4 else "bounded")
        # rho = 7 + sqrt(48) at h w = 4.
        rate = math.log(7 + math.sqrt(48)) / 0.4
        self.near(rows[2]["predicted_growth_rate"] / rate, 1, 1e-12)
        self.near(rows[2]["growth_rate"] / rate, 1, 1e-3)
        for implicit, explicit, h_omega in zip(rows[3:6], rows[9:12], (1, 2, 4)):
            rate = math.log1p(h_omega**2) / (0.2 * h_omega)  # |1 + i h w| a step, no transient
            self.near(explicit["growth_rate"] / rate, 1, 1e-6)
            self.near(implicit["growth_rate"] / rate, -1, 1e-6)
            self.assertEqual((implicit["outcome"], explicit["outcome"]), ("leaked", "diverged"))
        self.assertEqual({one["outcome"] for one in rows[12:]}, {"bounded"})
        self.assertEqual((rows[6]["predicted_growth_rate"], rows[6]["knob"]), (None, "rtol"))
        self.near(made(MAP).sidecar("out/map.json")["omega_max"], 10, 1e-11)

    def test_cells_beyond_all_numbers_and_all_steps_are_outcomes(self):
        verlet = "--scene oscillator --columns 2 --methods verlet"
        self.map(verlet + ",implicit_euler --amplitudes 1 --low 1 --high 1e300")
        one, other, _, _ = table("out/map.csv")
        self.assertEqual(one["outcome"], "bounded")
        self.assertNotEqual(other["outcome"], "bounded")
        self.assertIsNone(other["predicted_growth_rate"])
        ended = self.map(verlet + " --until 1.7976931348623157e308 --cell-limit 0.003")
        self.assertIn("over_budget", ended.stdout)

    def test_rows_vary_a_parameter_of_the_generator(self):
        self.map("--scene orbit --vary radius --amplitudes 1.1,1.5 --methods verlet --columns 2")
        self.assertEqual([one["amplitude"] for one in table("out/map.csv")], [1.1, 1.1, 1.5, 1.5])
        # An amplitude that cannot be leaves its row out.
        ended = self.map(
            "--scene strut --vary compression --methods verlet --columns 2 --amplitudes 0.5,1e9"
        )
        self.holds(ended.stderr, "compression = 1000000000", "its row is left out")
        self.assertEqual(len(table("out/map.csv")), 2)

    def test_a_damped_scene_has_limits_by_damping_ratio_and_modes_their_own(self):
        with open("damped.toml", "w", encoding="utf-8") as file:
            file.write('[generator]\nkind = "pendulum"\ndamping_time = 0.02\n')
        few = " --columns 1 --amplitudes 0.1 --step-size 1e-3"
        self.map("--scene damped.toml --methods verlet,implicit_midpoint" + few)
        limits = table("out/damped_limits.csv")
        self.assertEqual({one["method"] for one in limits}, {"verlet"})
        for one in limits:
            z = one["damping_ratio"]
            exact = 2 * (math.sqrt(1 + 4 * z * z) - 2 * z)
            self.near(one["h_omega_limit_predicted"] / exact, 1, 1e-12)
            self.near(one["h_omega_limit_measured"] / exact, 1, 1e-8)
        modes = [one for one in table("out/modal.csv") if one["method"] == "verlet"]
        fast = modes[-1]  # along the spring, c/k = 0.02 s: zeta = 0.01 w
        self.near(fast["damping_ratio_physical"] / (0.01 * fast["omega"]), 1, 1e-6)
        for one in modes:
            self.near(one["damping_ratio_measured"], one["damping_ratio_physical"], 1e-3)
        self.refused(
            "stability_map --out no --scene damped.toml --methods kahan_li8" + few,
            "damped.toml: damping: kahan_li8", "drifts back in time",
        )  # fmt: skip

    def test_modes_are_excited_where_the_scene_rests(self):
        methods = "--methods verlet,implicit_euler --step-size 0.01 --amplitudes 0.1 --columns 1"
        self.map("--scene pendulum " + methods)
        rows = table("out/modal.csv")
        self.assertEqual(len(rows), 6)
        # Across the spring w = sqrt(g/l), l = 1 + g/k; along it sqrt(k/m).
        across, along = math.sqrt(9.81 / (1 + 9.81 / 1000)), math.sqrt(1000)
        for one, w in zip(rows, (across, across, along)):
            self.near(one["omega"] / w, 1, 1e-9)
            self.assertEqual(one["verdict"], "lives")
            # cos(theta) = 1 - (h w)^2/2; the pendulum's cubic force is (3e-6)^2 of the linear one.
            theta = math.acos(1 - 0.5e-4 * w * w)
            self.near(one["period_error_measured"], 0.01 * w / theta - 1, 1e-8)
        self.assertEqual(rows[5]["verdict"], "is damped")  # zeta = atan(x)-like 0.16 at h w = 0.32

    def test_symmetric_formulas_have_a_row_each(self):
        rows = made(ROOTS).table("out/roots.csv")
        self.assertEqual(len(rows), 4 + 6 * (1 + 2 + 3 + 4 + 5))
        unstable = 0
        for number, one in enumerate(rows):
            self.assertEqual(len(str(one["cosines"]).split()), one["steps"] / 2 - 1)
            self.assertEqual(one["method"] is not None, number < 4)
            is_stable = one["limit"] > 0.5
            unstable += not is_stable
            for name in ("phase_error", "gap", "energy_swing"):
                self.assertEqual(one[name] is not None, is_stable)
        self.assertIn(unstable, range(1, 90))
        # symmetric4 gives 3 x - 4 x^2 = h^2 w^2 (3/2 - 9/4 x) in x = 1 - cos(theta), at most 2.
        b = 3 + 2.25 * 0.25
        own = math.acos(1 - (b - math.sqrt(b * b - 24 * 0.25)) / 8)
        self.near(rows[0]["phase_error"], abs(own / 0.5 - 1), 1e-12)
        self.near(rows[0]["limit"], math.sqrt(10 / 3), 1e-12)
        self.done("symmetric_roots --samples 2 --at 0.5 --out .")  # the same formulas
        self.assertTrue(all(one in rows for one in table("roots.csv")))
        origin = made(ROOTS).sidecar("out/roots.json")
        self.assertEqual((origin["at"], origin["samples"]), (0.5, 6))
