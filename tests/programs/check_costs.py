"""Studies of what runs cost: solvers, sizes, ratios of stiffness, SUNDIALS as it comes, advice."""

import itertools
import math
import os

from programs import CHAOS, Programs, read, rows_of, run, sidecar, study, table, write

# A cloth of 8 x 8 nodes.
LOCAL_GLOBAL = (
    "local_global --nodes 8 --iterations 30 --repeats 1 --swing 0.1 --stiffnesses 100,200"
    " --resolutions 4,6 --out out"
)
SOLVERS = {
    "local_global", "local_global_chebyshev", "local_global_anderson", "local_global_lbfgs",
    "newton_exact", "newton_clamped",
}  # fmt: skip
SCALING = "scaling --scenes chain,cloth --least-nodes 30 --most-nodes 300 --sizes 2 --out out"
# The motion is as in the default, the cloth is not.
CROSSOVER = (
    "crossover --nodes 5 --ratios 1e4,1 --repeats 1 --point-limit 5 --until 0.1 --out out"
    " --methods "
)
KINDS = {"explicit": "verlet,kahan_li8", "implicit": "ida,arkode_dirk3", "split": "arkode_imex3"}
FEW = 'name = "few"\nuntil = 0.05\n[generator]\nkind = "chain"\nnodes = 6\nstiffness = 1e3\n'
STOCK = "stock_sundials --scene few.toml --repeats 1 --rtol 1e-3,1e-6 --out out"
STOCK_COLUMNS = (
    "scene,method,rtol,outcome,stock_outcome,structured_s,stock_s,ratio,structured_error,"
    "stock_error,steps,stock_steps,newton_iterations,stiffness_evaluations,factorizations,"
    "stock_factorizations,indefinite_factorizations,structured_force,structured_stiffness,"
    "structured_factorization,structured_solve,structured_rest,stock_force,stock_stiffness,"
    "stock_factorization,stock_solve,stock_rest"
)


def ordered(rows, *columns):
    """The rows in groups of equal columns, as they stand."""
    return itertools.groupby(rows, key=lambda row: tuple(row[column] for column in columns))


class Solvers(Programs):
    def test_every_linear_solver_solves_and_is_held_against_the_machine(self):
        self.done("solvers --scene cloth --repeats 1 --out out")
        columns = "scene,unknowns,solver,analysis_s,factorization_s,solve_s,gflops,"
        columns += "gigabytes_per_second,bytes,residual"
        *solvers, machine = table("out/solvers.csv", columns)
        self.assertEqual(len(solvers), 4)
        for row in solvers:
            self.assertGreater(min(row["factorization_s"], row["solve_s"]), 0)
            # |b| is 2 and M - h^2 K of condition 10: rounding, and a thousand such errors.
            self.assertLess(row["residual"], 1e-11)
        self.assertGreater(min(machine["gflops"], machine["gigabytes_per_second"]), 0)

    def test_one_step_is_tabulated_by_solver_and_iteration(self):
        done = study(LOCAL_GLOBAL)
        columns = "solver,iteration,seconds,relative_error"
        rows = done.table("out/convergence.csv", columns)
        self.assertEqual({row["solver"] for row in rows}, SOLVERS)
        self.assertEqual(min(row["relative_error"] for row in rows), 0)  # of whoever came lowest
        for (solver,), group in ordered(rows, "solver"):
            start, *others = group
            self.assertEqual(list(start.values())[1:], [0, 0, 1])
            for one, other in zip([start, *others], others):
                self.assertGreater(other["iteration"], one["iteration"])
                self.assertGreater(other["seconds"], 0)
                # Chebyshev's polynomials may rise for a while.
                if solver != "local_global_chebyshev":
                    self.assertLessEqual(other["relative_error"], one["relative_error"] + 1e-12)
        for name, values in ("stiffness", {100, 200}), ("resolution", {4, 6}):
            column = {"resolution": "nodes"}.get(name, name)
            rows = done.table(f"out/{name}.csv", f"{column},{columns}")
            self.assertEqual({row[column] for row in rows}, values)
        columns = "solver,iterations,seconds,position_error,energy_change"
        last = done.table("out/run.csv", columns)[-1]
        self.assertEqual(last["solver"], "newton_exact")
        self.assertGreater(last["position_error"], 1e-4)
        self.assertLess(last["energy_change"], 0)  # implicit Euler damps

    def test_positions_come_to_those_of_the_converged_step_which_has_an_error_of_its_own(self):
        done = study(LOCAL_GLOBAL)
        columns = "solver,iteration,seconds,distance_to_converged,step_error"
        rows, origin = done.table("out/positions.csv", columns), done.sidecar("out/positions.json")
        own = origin["step_error"]
        self.assertGreater(own, 1e-5)
        self.assertEqual({row["step_error"] for row in rows}, {own})
        for _, group in ordered(rows, "solver"):
            # Thirty iterations, or as many of Newton's, solve this step far beyond its own error.
            self.assertLess(list(group)[-1]["distance_to_converged"], own)
        for solver in SOLVERS:
            setup = origin["setup"][solver]
            self.assertGreater(setup["analysis_s"], 0)
            self.assertEqual(setup["factorization_s"] > 0, not solver.startswith("newton"))
        errors = []
        for h in ("1e-4", "5e-5"):
            self.done(
                "local_global --nodes 5 --iterations 1 --repeats 1 --swing 0.05 --until 0.001"
                f" --stiffnesses 100 --resolutions 4 --stiffness 100 --step-size {h} --out {h}"
            )
            errors.append(sidecar(h + "/positions.json")["step_error"])
        # One step errs by h^2/2 of what is left of the acceleration.
        self.near(math.log2(errors[0] / errors[1]), 2, 0.1)


class Sizes(Programs):
    def test_phases_of_every_scene_and_size_add_up_to_the_step(self):
        done = study(SCALING)
        columns = "scene,nodes,springs,method,phase,seconds,bytes"
        sizes, seen = {"chain": set(), "cloth": set()}, 0
        rows = done.table("out/scaling.csv", columns)
        for (scene, nodes, method), group in ordered(rows, "scene", "nodes", "method"):
            seen += 1
            sizes[scene].add(nodes)
            phases = {}
            for row in group:
                self.assertNotIn(row["phase"], phases)
                phases[row["phase"]] = row["seconds"]
                self.assertTrue(scene == "cloth" or row["springs"] == nodes - 1)
                self.assertTrue(row["seconds"] > 0 or row["phase"] == "rest")
                if row["phase"] == "factorization":
                    self.assertGreater(row["bytes"], 8 * 3 * nodes)
            expected = {
                None: "reduce scene",
                "verlet": "force rest step",
                "semi_implicit_euler": "factorization force rest solve step stiffness symbolic",
                "semi_implicit_euler:conjugate_gradients": "force iterations preconditioner rest"
                " step stiffness symbolic",
            }[method]
            self.assertEqual(sorted(phases), expected.split())
            if method:  # five sums and differences round
                parts = phases.keys() - {"step", "symbolic"}
                self.near(sum(phases[name] for name in sorted(parts)) / phases["step"], 1, 1e-14)
        self.assertEqual(sizes, {"chain": {30, 95, 300}, "cloth": {25, 100, 289}})
        # The phases before any method, an explicit one, an implicit one with each of two solvers.
        self.assertEqual(seen, 6 * 4)

    def test_exponents_and_roofline_have_their_tables(self):
        done = study(SCALING)
        columns = "scene,method,phase,exponent,low,high,theory,nodes_from,nodes_to"
        for row in done.table("out/exponents.csv", columns):
            self.assertTrue(row["low"] <= row["exponent"] <= row["high"])
        columns = "scene,nodes,springs,seconds,springs_per_second,bytes_per_spring,"
        columns += "flops_per_spring,working_set_bytes,triad_bytes_per_second,peak_flops_per_second"
        rows = done.table("out/roofline.csv", columns)
        self.assertEqual(len(rows), 6)
        for row in rows:
            self.assertGreater(min(row["seconds"], row["triad_bytes_per_second"]), 0)
            # A vector operation does one multiplication and addition a cycle at the very least; no
            # core does a thousand.
            self.assertTrue(1e8 < row["peak_flops_per_second"] < 1e13)

    def test_what_would_take_too_much_is_left_out_and_said_to_be(self):
        for scene, words, said in (
            ("lattice", "--least-nodes 60 --most-nodes 300 --sizes 2 --memory-limit 1e-9", "GB"),
            # A first scene that does not fit is not drawn.
            ("cloth", "--least-nodes 1e6 --most-nodes 1e6 --memory-limit 0.1 --time-limit 20",
             "GB, more than 0.1 GB"),
        ):  # fmt: skip
            ended = self.done(f"scaling --scenes {scene} {words} --out out --force")
            self.holds(ended.stdout, f"left out: {scene}", said)
            self.assertEqual(sidecar("out/scaling.json")["left_out"][0]["scene"], scene)


class Ratios(Programs):
    def setUp(self):
        super().setUp()
        self.crossed = study(CROSSOVER + ",".join(KINDS.values()))
        self.points = self.crossed.table("out/points.csv")

    def good(self, ratio, accuracy):
        """The points at a ratio that are that accurate."""
        reached = [row for row in self.points if row["outcome"] == "reached_end"]
        there = [row for row in reached if row["stiffness_ratio"] == ratio]
        return [row for row in there if row["error_position"] <= accuracy]

    def test_the_winner_is_the_fastest_point_and_the_margin_that_of_the_next_method(self):
        out, compared = self.crossed / "out", 0
        written = "crossover.csv crossover.json kinds.csv kinds.json points.csv points.json"
        others = ["ratio_1", "ratio_10000", "rods.csv", "rods.json"]
        self.assertEqual(sorted(os.listdir(out)), [*written.split(), *others])
        columns = "stiffness_ratio,accuracy,{}method,time_s"
        rows = table(out + "/crossover.csv", columns.format("") + ",runner_up,margin")
        cells = list(itertools.product((1, 1e4), (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)))
        self.assertEqual([(row["stiffness_ratio"], row["accuracy"]) for row in rows], cells)
        for row, asked in zip(rows, cells):
            good = sorted((p["time_s"], p["method"]) for p in self.good(*asked))
            time, first = good[0] if good else (None, None)
            later = [point for point in good if point[1] != first]
            second, margin = (later[0][1], later[0][0] / time) if later else (None, None)
            found = [row[name] for name in ("method", "time_s", "runner_up", "margin")]
            self.assertEqual(found, [first, time, second, margin])
            compared += bool(later)
        self.assertGreater(compared, 0)  # how many of 12 depends on the load
        kinds = table(out + "/kinds.csv", columns.format("kind,"))
        self.assertEqual(len(kinds), 3 * len(rows))
        for kind, methods in KINDS.items():
            of_it = {row["method"] for row in kinds if row["kind"] == kind}
            self.assertLessEqual(of_it, {None, *methods.split(",")})

    def test_split_methods_run_only_where_springs_are_stiff(self):
        ratios = {p["stiffness_ratio"] for p in self.points if p["method"] == "arkode_imex3"}
        self.assertEqual(ratios, {1e4})

    def test_explicit_steps_are_as_many_as_the_root_of_the_ratio_and_implicit_are_not(self):
        grown = {}
        for method in ("verlet", "ida"):
            soft, stiff = (
                min(row["steps"] for row in self.good(ratio, 0.1) if row["method"] == method)
                for ratio in (1, 1e4)
            )
            grown[method] = stiff / soft
        # There are up to sqrt(1e4) = 100 times the steps. They are fewer, since all springs of a
        # node count at ratio 1 and only the frame's at 1e4, and since step sizes differ by factors
        # of two.
        self.assertTrue(20 < grown["verlet"] < 200, grown)
        self.assertLess(grown["ida"], 20)

    def test_a_sidecar_says_how_it_was_made_and_how_certain_it_is(self):
        for name in ("crossover", "kinds", "points"):
            origin = self.crossed.sidecar(f"out/{name}.json")
            self.assertEqual((origin["family"], origin["until"]), ("frame", 0.1))
            _, stiffest = origin["scenes"]
            self.assertEqual((stiffest["stiffness_ratio"], stiffest["scene"]["nodes"]), (1e4, 25))
            self.assertTrue(0 < stiffest["certified_position"] <= 1e-7)
            self.assertTrue(stiffest["reference_made_by"])

    def test_the_other_families_have_their_maps_too(self):
        for family in ("whole", "chain"):
            self.done(f"{CROSSOVER}verlet,ida --family {family} --force")
            winners = table("out/crossover.csv")
            self.assertEqual((len(winners), len(table("out/kinds.csv"))), (12, 24))  # none is split
            self.assertIsNotNone(winners[0]["method"])
            self.assertEqual(table("out/points.csv")[0]["scene"], family)


class Stock(Programs):
    """SUNDIALS as it comes, beside our structure."""

    def rows(self):
        return study(STOCK, ("few.toml", FEW)).table("out/structure.csv", STOCK_COLUMNS)

    def test_both_ways_take_the_same_steps_to_the_same_error(self):
        done, rows = study(STOCK, ("few.toml", FEW)), self.rows()
        listed = rows_of(run("simulate --list-methods --csv").stdout)
        pairs = [row["stock_of"] for row in listed if row["stock_of"]]
        self.assertEqual(len(pairs), 6)
        self.assertEqual([row["method"] for row in rows], [name for name in pairs for _ in "ab"])
        self.assertEqual(done.sidecar("out/structure.json")["until"], 0.05)
        written = ["reference.json", "structure.csv", "structure.json"]
        self.assertEqual((sorted(os.listdir(done / "out")), done.err), (written, ""))
        for row in rows:
            kept = (row["scene"], row["outcome"], row["stock_outcome"])
            self.assertEqual(kept, ("few", "reached_end", "reached_end"))
            self.assertTrue(0 < row["structured_error"] < 0.1)
            # Rounding alone sets them apart, by up to 7e-9 of the error, and by 2e-6 where ARKODE
            # takes rates from differences of solutions.
            apart = 1e-5 if row["method"].startswith("arkode") else 1e-6
            self.near(row["stock_error"] / row["structured_error"], 1, apart)
            self.assertEqual(row["steps"], row["stock_steps"])
            self.assertEqual(row["factorizations"], row["stock_factorizations"])
            for name in ("steps", "newton_iterations", "stiffness_evaluations", "structured_s"):
                self.assertGreater(row[name], 0)
            self.assertLessEqual(row["indefinite_factorizations"], row["factorizations"])
            self.assertEqual(row["ratio"], row["stock_s"] / row["structured_s"])
            for way in ("structured", "stock"):
                phases = ("force", "stiffness", "factorization", "solve", "rest")
                shares = [row[f"{way}_{phase}"] for phase in phases]
                self.assertTrue(0 < min(shares) and max(shares) < 1)
                self.near(sum(shares), 1, 5 * 2.2e-16)  # five numbers below 1, each rounded
        for coarse, fine in zip(rows[::2], rows[1::2]):  # another tolerance has another error
            self.assertEqual((coarse["rtol"], fine["rtol"]), (1e-3, 1e-6))
            self.assertGreater(abs(fine["stock_error"] / coarse["structured_error"] - 1), 0.05)
            self.assertNotEqual(fine["steps"], coarse["stock_steps"])

    def test_the_tolerances_are_those_of_work_precision(self):
        write("few.toml", FEW)
        self.done(
            "work_precision --scene few.toml --methods arkode_dirk4,ida --point-limit 1 --repeats 1"
            " --out out"
        )
        # Powers of ten as they are computed and as they are read.
        points = table("out/points.csv")
        steps = {(row["method"], f"{row['value']:.9g}"): row["steps"] for row in points}
        for row in self.rows():
            if row["method"] in ("arkode_dirk4", "ida"):
                self.assertEqual(row["steps"], steps[row["method"], f"{row['rtol']:.9g}"])

    def test_several_pairs_of_runs_are_one_row_and_one_that_fails_has_no_times(self):
        line = "stock_sundials --scene pendulum --until 0.2 --methods ida --rtol 1e-4 --repeats 5"
        self.done(line + " --out out")
        (row,) = table("out/structure.csv")
        self.assertGreater(min(row["ratio"], row["stock_s"]), 0)
        write("few.toml", FEW)
        self.done(
            "stock_sundials --scene few.toml --repeats 1 --methods arkode_dirk2 --rtol 1e-15,1e-3"
            " --until 0.01 --point-limit 0.05 --out late"
        )
        # Steps of an error of third order: some hundred thousand.
        late, good = table("late/structure.csv")
        self.assertEqual((late["outcome"], late["stock_outcome"]), ("over_budget", "over_budget"))
        empty = "structured_s stock_s ratio structured_error stock_error"
        for name in (empty + " structured_force structured_rest stock_rest").split():
            self.assertIsNone(late[name])
        self.assertEqual(good["outcome"], "reached_end")


class Advice(Programs):
    """Runs that are asked for by their accuracy: advise, and simulate --accuracy."""

    def test_it_says_what_to_take_and_the_command_line_runs(self):
        ended = self.done("advise --scene cloth --until 0.05 --accuracy 1e-2,1e-4,1e-8 --out out")
        self.holds(ended.stdout, "w_max", "own frequency", "stable up to", "take")
        columns = "accuracy,method,knob,value,predicted_error,predicted_time_s,runner_up,margin"
        rows = table("out/advice.csv", columns)
        self.assertEqual([row["accuracy"] for row in rows], [1e-2, 1e-4, 1e-8])
        for row in rows:
            self.assertLessEqual(row["predicted_error"], row["accuracy"])
            # A machine that is busy may have no time for a run of a second method.
            self.assertEqual(bool(row["runner_up"]), row["margin"] is not None)
            self.assertGreaterEqual(row["margin"] or 1, 1)
            self.assertIn(f"--method {row['method']}", ended.stdout)
            option = "--" + row["knob"].replace("_", "-")
            line = f"simulate --scene cloth --until 0.05 --method {row['method']} {option}"
            self.done(f"{line} {row['value']!r}")

    def test_the_command_line_has_the_reductions_that_were_left_out(self):
        ended = self.done(
            "advise --scene pendulum --until 1 --accuracy 1e-3 --no-reduce dimension,mirror"
        )
        said = "simulate --scene pendulum --no-reduce dimension,mirror --until 1 "
        self.assertIn("\n" + said, ended.stdout)
        # Who called it by another program's help copies a line that does so, too.
        called = run(
            "advise --scene pendulum --until 1 --accuracy 1e-3",
            env=os.environ | {"QDDOT_CALLER": "python3 -m qddot"},
        )
        self.assertIn("\npython3 -m qddot simulate --scene pendulum --until 1 ", called.stdout)

    def test_an_answer_has_its_error_bar_in_words_and_beside_its_file(self):
        ended = self.done(
            "simulate --scene pendulum --until 2 --accuracy 1e-6 --final end.csv"
            " --energy energy.csv --every 0.5"
        )
        self.holds(ended.stdout, "error at most", "for its check")
        origin = sidecar("end.json")
        self.assertLessEqual(origin["error_estimate"], 1e-6)
        # Which check is the cheaper one is decided by measured times.
        self.assertIn(origin["error_estimate_kind"], ("compared", "refined"))
        kept = [origin[key] for key in ("is_reached", "accuracy_of", "advised_by", "horizon")]
        self.assertEqual(kept, [True, "positions", "tolerance", None])
        self.near(sum(origin["seconds_by_phase"].values()) / origin["seconds"], 1, 1e-9)
        self.assertEqual(len(table("energy.csv")), 5)
        # The same end as by the method that it names.
        option = "--" + origin["knob"].replace("_", "-")
        named = f"simulate --scene pendulum --until 2 --method {origin['method']} {option}"
        self.done(f"{named} {origin['value']!r} --final 2.csv")
        if origin["knob"] == "step_size":
            self.assertEqual(read("end.csv"), read("2.csv"))

    def test_what_cannot_be_had_is_said_and_what_was_reached_is_there(self):
        write("chain.toml", CHAOS)
        line = "simulate --scene chain.toml --accuracy 1e-4 --final end.csv"
        self.complains(line, 3, "was not reached", "chaotic", "energy")
        self.assertEqual(len(table("end.csv")), 4)
        self.assertFalse(sidecar("end.json")["is_reached"])
        self.assertLess(sidecar("end.json")["horizon"], 12)
        advised = run("advise --scene chain.toml --accuracy 1e-4")
        self.complains(advised, 3, "no method is known to reach 1 of 1 accuracies")
        self.holds(advised.stdout, "none: the motion is chaotic", "energy")

    def test_the_study_judges_what_was_claimed(self):
        self.done("advice --cases 3 --first 11000012 --repeats 1 --reference-seconds 0.3 --out out")
        self.assertEqual(len(table("out/cases.csv")), 3)
        self.assertGreaterEqual(len(table("out/worth.csv")), 9)

    def test_the_study_judges_hard_motions_and_writes_their_scenes(self):
        # The first of them has own forces, and no scene.
        ended = self.done("advice --hard --cases 2 --first 20000054 --scenes --out out")
        rows = table("out/hard.csv")
        self.assertEqual([row["of"] for row in rows], ["energy", "positions"])
        self.holds(ended.stdout, rows[0]["kind"], rows[1]["kind"], "within_bar")
        scenes = [name for name in os.listdir("out") if name.endswith(".toml")]
        self.assertEqual(scenes, ["case_20000055.toml"])
        said = f"simulate --scene out/{scenes[0]} --method dprkn12 --rtol 1e-6"
        self.done(f"{said} --until {rows[1]['until'] / 2!r}")
        of = {row["of"] for row in table("out/hard_worth.csv", "of,figure,value,cases,meaning")}
        self.assertLessEqual({"all", "positions", "energy"}, of)

    def test_the_study_measures_states_between_steps(self):
        # A motion of two blocks, with its largest errors on the way.
        ended = self.done("advice --hard --samples --cases 1 --first 500026 --out out")
        self.assertEqual(len(table("out/sampled_cases.csv", "case,left_out,conditioning")), 1)
        rows = table("out/samples.csv")
        for row in rows:
            self.assertLessEqual(row["ratio"], row["plain_ratio"])
            self.assertLessEqual(row["ratio"], 20, row)
        # Ends of steps tell interpolation from a motion whose error is largest on its way.
        self.assertGreater(max(row["plain_ratio"] for row in rows), 20)
        sums = table("out/samples_by_method.csv")
        self.assertEqual(sum(row["runs"] for row in sums), len(rows))
        self.holds(ended.stdout, *(row["method"] for row in sums))
