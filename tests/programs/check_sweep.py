"""Sweeps: tasks that any process may measure, killed or not, and what is said of failed ones."""

import fcntl
import functools
import glob
import itertools
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import time
import unittest
import zlib

from programs import BIN, Programs, Study, read, run, sidecar, started, table, wait, write

# Two scenes, few methods, and runs short enough to be repeated often; which points are taken does
# not depend on how long they take.
SMALL = """scenes = ["pendulum", { generator = "chain", nodes = 6 }]
until = 0.05
methods = ["verlet", "implicit_euler", "blanes_moan4", "ida"]
accuracies = [1e-2, 1e-4]
[options]
point-limit = 60
repeats = 1
"""
REFERENCES, POINTS = "sweep run S --stage references", "sweep run S --stage points"
MERGE = "sweep merge S --no-pictures"
TIMED = ("time_s", "time_min_s", "setup_s", "timed_runs")
ROOTS = ("processor", "estimated_root", "estimated")
MAGIC = b"qddot journal 1\n"


def untimed(path):
    """The rows of points.csv but for what differs from one measurement to the next."""
    return sorted(str({k: v for k, v in row.items() if k not in TIMED}) for row in table(path))


@functools.cache
def points_of_one_process():
    """The points of the small study, each scene measured by one process."""
    files = (("chain.toml", '[generator]\nkind = "chain"\nnodes = 6\n'),)
    rows = []
    for scene in ("pendulum", "chain.toml"):
        done = Study(
            f"work_precision --scene {scene} --until 0.05 --accuracies 1e-2,1e-4 --point-limit 60"
            " --methods verlet,implicit_euler,blanes_moan4,ida --repeats 1 --out one",
            files,
        )
        rows += untimed(done / "one/points.csv")
    return sorted(rows)


@functools.cache
def measured_sweep(stage):
    """A sweep of the small study that is planned, or measured up to a stage, and not merged."""
    done = Study("sweep plan study.toml --out S", (("study.toml", SMALL),))
    for line in {"": (), "references": (REFERENCES,), "points": (REFERENCES, POINTS)}[stage]:
        assert run(line, cwd=done.path).returncode == 0
    return done


def records(path):
    """The records of a journal: its key, and its pieces."""
    with open(path, "rb") as file:
        data = file.read().removeprefix(MAGIC)
    found = []
    while data:
        size = struct.unpack("<I", data[:4])[0]
        found.append(data[8 : 8 + size])
        data = data[8 + size :]
    return found


def write_journal(path, contents):
    with open(path, "wb") as file:
        file.write(MAGIC)
        for one in contents:
            file.write(struct.pack("<II", len(one), zlib.crc32(one)) + one)


class Sweeps(Programs):
    def sweep(self, text=SMALL, measured=None):
        """Plans a sweep S in this folder; `measured`: the small one, as far as a stage."""
        write("study.toml", text)
        if measured is not None:
            shutil.copytree(measured_sweep(measured) / "S", "S")
            return None
        return run("sweep plan study.toml --out S")

    def tasks(self):
        return [json.loads(line) for line in read("S/tasks.jsonl").splitlines()]

    def task(self, scene, share):
        (one,) = (t for t in self.tasks() if (t["folder"], t["share"]) == (scene, share))
        return one["id"]

    def whole(self, scene, share):
        return f"S/tasks/whole/{self.task(scene, share)}.journal"

    def measured(self):
        """The files of whole tasks and what they hold."""
        return {os.path.basename(path): records(path) for path in glob.glob("S/tasks/whole/*")}

    def machines(self):
        """This machine's processor as keys name it, and another one."""
        cpu = sidecar("S/chain/reference.json")["cpu"].encode()
        return cpu, b"Z" * len(cpu)

    def check_as_one_process(self):
        """Merges. Nothing may be missing, and the points must be those of one process."""
        self.done(MERGE)
        self.assertEqual(untimed("S/points.csv"), points_of_one_process())
        self.assertEqual((table("S/missing.csv"), os.listdir("S/tasks/begun")), ([], []))


class Plans(Sweeps):
    def test_a_plan_has_references_first_and_a_task_for_each_method_of_each_scene(self):
        self.holds(self.sweep().stdout, "2 scenes, 2 references, 8 tasks of points")
        tasks = self.tasks()
        self.assertEqual([one["stage"] for one in tasks], ["references"] * 2 + ["points"] * 8)
        self.assertEqual([one["share"] == "reference" for one in tasks], [True] * 2 + [False] * 8)
        self.assertEqual(len({one["id"] for one in tasks}), 10)

    def test_a_task_is_named_by_all_that_decides_what_it_measures_and_by_nothing_else(self):
        self.sweep()
        own = self.task("chain", "verlet")
        others = {self.task("chain", "ida"), self.task("pendulum", "verlet")}
        for old, new, is_same in (
            ("", "", True), ('"ida"', '"ida", "rk4"', True), ('"pendulum"', '"orbit"', True),
            ("nodes = 6", "nodes = 7", False), ("until = 0.05", "until = 0.06", False),
            ("1e-4", "1e-5", False), ("repeats = 1", "repeats = 2", False),
        ):  # fmt: skip
            os.makedirs("elsewhere", exist_ok=True)
            write("elsewhere/study.toml", SMALL.replace(old, new, 1))
            self.done("sweep plan elsewhere/study.toml --out S")
            self.assertEqual(self.task("chain", "verlet") == own, is_same, new)
        self.assertNotIn(own, others)

    def test_methods_that_cannot_run_a_scene_are_left_out_of_it_alone(self):
        self.sweep('scenes = ["oscillator", "pendulum"]\nmethods = ["exact", "verlet"]\n')
        shares = {(one["folder"], one["share"]) for one in self.tasks() if one["stage"] == "points"}
        left = {("oscillator", "exact"), ("oscillator", "verlet"), ("pendulum", "verlet")}
        self.assertEqual(shares, left)

    def test_a_plan_of_another_build_or_a_damaged_one_is_refused(self):
        self.sweep()
        tasks = self.tasks()
        for one in tasks:
            one["key"]["build"]["flags"] = "-O0"
        # A key that was changed by hand does not fit its id.
        write("S/tasks.jsonl", "".join(json.dumps(one) + "\n" for one in tasks))
        self.complains(POINTS, 2, "tasks.jsonl:1: it is no task as sweep plan writes it")
        for damage in ("", "{", "[1]\n", '{"id": 3}\n'):
            write("S/tasks.jsonl", damage)
            self.complains(MERGE, 2, "tasks.jsonl")

    def test_lines_for_slurm_and_parallel_hold_what_was_asked_for(self):
        self.sweep(measured="")
        lines = self.done(
            "sweep submit S --slurm --partition=short --time 2:00:00 --shards 5"
        ).stdout
        self.assertEqual(lines.count("\n"), 3)
        self.holds(
            lines, "references=$(sbatch ", "--array=1-2 ", "points=$(sbatch ", "--array=1-5 ",
            '--dependency=afterok:"$references"', "merge=$(sbatch ",
            '--dependency=afterany:"$points"', "--threads-per-core=1",
            "--partition=short --time 2:00:00 --wrap=", '--shard "$SLURM_ARRAY_TASK_ID/5"',
        )  # fmt: skip
        self.holds(
            self.done("sweep submit S --parallel --sshlogin a,b").stdout,
            "seq 2 | parallel ", "seq 8 | parallel ", "--sshlogin a,b ", "--shard {}/8", "merge",
        )  # fmt: skip

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_parallel_runs_its_lines(self):
        self.sweep(measured="")
        self.done("sweep submit S --parallel --go --shards 3")
        self.assertEqual(untimed("S/points.csv"), points_of_one_process())
        self.assertTrue(os.path.exists("S/fastest.png") and os.path.exists("S/chain/report.html"))


class Tasks(Sweeps):
    def test_shards_measure_the_points_of_one_process_and_nothing_twice(self):
        self.sweep(measured="references")
        self.done(POINTS + " --shard 3/3")
        before = self.measured()
        for shard, said in ("1/3", "of 3 tasks are done"), ("2/3", "of 3 tasks are done"):
            self.holds(self.done(f"{POINTS} --shard {shard}").stdout, said)
        self.assertEqual((len(before), len(self.measured())), (4, 10))
        self.done(REFERENCES)
        self.assertEqual({name: self.measured()[name] for name in before}, before)
        self.check_as_one_process()
        columns = "along,accuracy,low,high,crossing,scene_low,scene_high,method_low,method_high"
        table("S/crossovers.csv", columns + ",margin")
        for scene in ("pendulum", "chain"):  # the accuracies that were asked for
            self.assertEqual(len(table(f"S/{scene}/front.csv")), 2)
        # The tables say how one process would make them: a study that --resume finds complete.
        program, *words = sidecar("S/pendulum/points.json")["command_line"]
        self.assertNotIn("--kept", words)
        again = self.done([os.path.basename(program), *words, "--resume"])
        self.assertIn("nothing is missing", again.stderr)
        # Nor is anything measured twice where the study grows.
        before = self.measured()
        planned = self.sweep(SMALL.replace('"ida"', '"ida", "rk4"'))
        self.holds(planned.stdout, "10 tasks of points; 10 of these are measured already")
        self.done(POINTS)
        self.assertEqual(len(self.measured()), 12)
        self.assertEqual({name: self.measured()[name] for name in before}, before)

    def test_killed_at_any_moment_it_loses_nothing_that_was_measured(self):
        self.sweep(measured="")
        kills = 0
        for line in (REFERENCES, POINTS):
            for seconds in (0.005 * 1.25**i for i in itertools.count()):
                before = self.measured()
                process = started(line)
                time.sleep(seconds)
                ended = self.signalled(process, signal.SIGKILL)
                self.assertLessEqual(before.items(), self.measured().items())
                if ended.returncode == 0:
                    break
                self.assertEqual(ended.returncode, -signal.SIGKILL)
                kills += 1
        self.assertGreater(kills, 5)
        self.check_as_one_process()

    def test_what_it_runs_ends_with_it(self):
        self.sweep(
            'scenes = ["pendulum"]\nuntil = 5\nmethods = ["explicit_euler"]\n'
            "[options]\npoint-limit = 60\n"
        )
        self.done(REFERENCES)

        def is_running():
            return "1 running" in run("sweep status S").stdout

        def status(name):
            return re.search(rf"{name}:\s*(\w+)", read(f"/proc/{child}/status"))[1]

        process = started(POINTS)
        wait(is_running)  # its runs take minutes
        threads = glob.glob(f"/proc/{process.pid}/task/*/children")
        (child,) = " ".join(map(read, threads)).split()
        # While a process is stopped, signals that are sent to it wait.
        os.kill(int(child), signal.SIGSTOP)
        wait(lambda: status("State") == "T")
        process.send_signal(signal.SIGTERM)
        wait(lambda: int(status("ShdPnd"), 16) & 1 << signal.SIGTERM - 1)
        os.kill(int(child), signal.SIGCONT)
        self.complains(self.signalled(process, 0), 130, "interrupted by SIGTERM")
        process = started(POINTS)
        wait(is_running)
        self.signalled(process, signal.SIGKILL)
        wait(lambda: not is_running())

    def begun_task(self, host):
        """Makes a measured sweep look as if a process there had been killed after the first point
        of a task; the file of the whole task, the begun one, and its records."""
        self.sweep(measured="points")
        place = self.whole("chain", "verlet")
        key, first, *_ = records(place)
        begun = f"S/tasks/begun/{self.task('chain', 'verlet')}.{host}.77.journal"
        os.remove(place)
        write_journal(begun, [key, first])
        return place, begun, key, first

    def test_points_of_a_task_that_was_killed_are_kept(self):
        place, begun, key, first = self.begun_task("elsewhere")
        self.holds(self.done("sweep status S").stdout, "1 begun and ended")
        self.done(POINTS)
        self.assertIn(first, records(place))
        self.assertEqual(os.listdir("S/tasks/begun"), [])
        # Seconds of another machine do not count.
        os.remove(place)
        write_journal(begun, [key.replace(*self.machines()), first])
        self.done(POINTS)
        self.assertNotIn(first, records(place))

    def test_a_task_that_another_process_lets_go_soon_is_measured(self):
        # The child of a process that was killed holds the lock of its task for a moment.
        for is_let_go in (True, False):
            shutil.rmtree("S", ignore_errors=True)
            place, begun, _, first = self.begun_task(os.uname().nodename)
            with open(begun, encoding="latin-1") as held:
                fcntl.flock(held, fcntl.LOCK_EX)
                self.holds(self.done("sweep status S").stdout, "1 running")
                process = started(POINTS)
                time.sleep(0.5 if is_let_go else 0)
                if not is_let_go:
                    out = process.communicate()[0]
                    self.assertEqual(process.returncode, 3)
                    self.assertIn("1 are measured elsewhere", out)
            if is_let_go:
                process.communicate()
                self.assertEqual(process.returncode, 0)
                self.assertIn(first, records(place))

    def test_two_that_run_the_same_shard_do_no_harm(self):
        self.sweep(measured="references")
        for process in [started(POINTS), started(POINTS)]:
            process.communicate()
            # It has done its tasks, or has seen that the other is at them.
            self.assertIn(process.returncode, (0, 3))
        self.check_as_one_process()

    def test_a_time_limit_ends_it_in_order_and_the_next_call_goes_on(self):
        self.sweep(measured="references")
        calls, limit = 0, 0.05  # it grows, since a busy machine might measure nothing in that time
        while (ended := run(f"{POINTS} --time-limit {limit}")).returncode != 0:
            self.complains(ended, 3, "interrupted by --time-limit")
            calls, limit = calls + 1, 1.2 * limit
        self.assertGreater(calls, 0)
        self.check_as_one_process()

    def test_other_studies_are_divided_in_the_same_way(self):
        for text, tables in (
            ('program = "stability_map"\nscenes = ["pendulum"]\nuntil = 0.5\n'
             'methods = ["verlet", "implicit_euler", "ida"]\n[options]\n'
             "columns = 3\namplitudes = [0.1, 1]\ncell-limit = 60\n",
             "limits linear adaptive modal map"),
            ('program = "energy_drift"\nscenes = ["orbit"]\nuntil = 200\n'
             'methods = ["verlet", "ida"]\n[options]\nstep-size = 0.01\nmethod-limit = 60\n',
             "drift"),
        ):  # fmt: skip
            self.assertEqual(self.sweep(text).returncode, 0)
            for line in (REFERENCES, POINTS, MERGE):
                self.done(line)
            task = self.tasks()[0]
            self.done([task["program"], *task["arguments"], "--out", "one"])
            for name in tables.split():
                merged = read(f"S/{task['folder']}/{name}.csv")
                self.assertEqual(merged, read(f"one/{name}.csv"), name)
            shutil.rmtree("S")

    def test_ratios_of_crossover_and_cases_of_advice_are_tasks(self):
        # One process would give up the slower of the two early at the second ratio.
        self.sweep(
            'program = "crossover"\nmethods = ["explicit_euler", "verlet"]\n[options]\n'
            'family = "chain"\nnodes = 5\nratios = [1, 10]\nuntil = 0.02\nrepeats = 1\n'
            "point-limit = 0.05\n"
        )
        for line in (REFERENCES, POINTS, MERGE):
            self.done(line)
        # A run that will take too long is not begun.
        rows = [row for row in table("S/crossover/points.csv") if row["steps"] > 0]
        self.assertEqual({row["stiffness_ratio"] for row in rows}, {1, 10})
        for one in self.tasks():
            pieces = records(self.whole("crossover", one["share"]))[2:]  # without key and mark
            ratio = float(one["share"])
            self.assertEqual(len(pieces), sum(row["stiffness_ratio"] == ratio for row in rows))
        shutil.rmtree("S")
        self.sweep(
            'program = "advice"\n[options]\ncases = 2\nfirst = 11000003\nrepeats = 1\n'
            "reference-seconds = 0.2\n"
        )
        self.assertEqual({one["share"] for one in self.tasks()}, {"11000003", "11000004"})


class Machines(Sweeps):
    """A sweep that is whole, but whose chain's Verlet was measured on another kind of machine."""

    def setUp(self):
        super().setUp()
        self.sweep(measured="points")
        place = self.whole("chain", "verlet")
        key, *pieces = records(place)
        write_journal(place, [key.replace(*self.machines()), *pieces])
        self.other = self.machines()[1].decode()

    def test_seconds_of_unlike_machines_are_never_put_on_one_front(self):
        said = f"{self.other} (1 tasks)"
        self.complains(MERGE, 2, said, "(7 tasks)", "--per-machine", "--by work")
        self.assertFalse(os.path.exists("S/points.csv"))
        said = self.done("sweep status S").stdout
        self.holds(said, "measured on unlike machines", self.other)
        self.done(MERGE + " --per-machine")
        first, second = (
            {row["method"] for row in table(f"S/machines/{number}/points.csv")} for number in (1, 2)
        )
        self.assertEqual(first, {"blanes_moan4", "ida", "implicit_euler", "verlet"})
        self.assertEqual(second, {"verlet"})
        self.assertIn(self.other, read("S/machines/2/chain/points.json"))

    def test_what_other_machines_measured_is_measured_again_where_that_is_asked_for(self):
        before = self.measured()
        self.done(POINTS)
        self.assertEqual(self.measured(), before)
        self.done(POINTS + " --again")
        after = self.measured()
        self.assertEqual(sum(after[name] != before[name] for name in before), 1)
        self.check_as_one_process()

    def test_by_work_times_are_counts_times_costs_on_this_machine(self):
        self.done(MERGE + " --by work")
        kept = read("S/chain/costs.json")
        costs = json.loads(kept)["seconds"]
        for row in table("S/chain/points.csv"):
            if row["outcome"] != "reached_end":
                continue
            counted = ("force_evaluations", "stiffness_evaluations", "factorizations", "solves")
            priced = ("force", "stiffness", "factorization", "solve")
            work = sum(row[count] * costs[price] for count, price in zip(counted, priced))
            self.assertTrue(costs["force"] > 0 and costs["factorization"] > 0)
            self.near(row["time_s"] / work, 1, 1e-15)  # four products and sums
        self.assertEqual(sidecar("S/sweep.json")["times"], "work")
        # Errors and counts stay those that were measured, and costs are not measured twice.
        self.assertEqual(untimed("S/points.csv"), points_of_one_process())
        self.done(MERGE + " --by work")
        self.assertEqual(read("S/chain/costs.json"), kept)


class Roots(Sweeps):
    """Each process chooses the fastest roots by a measurement of its own, so two may differ."""

    def has(self, roots):
        """Whether this processor has such roots."""
        line = "simulate --scene cloth --method verlet --step-size 1e-4 --until 1e-3"
        return run(line, env=os.environ | {"QDDOT_ROOTS": roots}).returncode == 0

    def run_with(self, roots, line):
        os.environ["QDDOT_ROOTS"] = roots
        self.addCleanup(os.environ.pop, "QDDOT_ROOTS", None)
        return self.done(line)

    def test_processes_with_unlike_roots_measure_one_study(self):
        self.sweep()
        other = [name for name in ROOTS if self.has(name)][-1]
        self.run_with("processor", REFERENCES)
        self.run_with(other, f"{POINTS} --task {self.task('chain', 'verlet')}")
        before = self.measured()
        self.run_with("processor", POINTS + " --again")  # nothing is of another machine
        self.assertLessEqual(before.items(), self.measured().items())
        self.check_as_one_process()
        used = ", ".join(sorted({"processor", other}))
        self.assertEqual(sidecar("S/chain/points.json")["roots"], used)
        # A study that is complete is so with other roots.
        line = "convergence --scene pendulum --until 0.05 --methods verlet --out . --resume"
        self.run_with(other, line)
        self.assertIn("nothing is missing", self.run_with("processor", line).stderr)


class Faults(Sweeps):
    def test_a_task_that_other_code_measured_and_a_damaged_one_do_not_count(self):
        self.sweep(measured="points")
        place = self.whole("chain", "ida")
        key, *pieces = records(place)
        code = self.tasks()[0]["key"]["build"]["code"].encode()
        write_journal(place, [key.replace(code, b"0" * len(code)), *pieces])
        place = self.whole("pendulum", "ida")
        os.truncate(place, os.path.getsize(place) - 3)
        self.holds(self.done("sweep status S").stdout, "6 done, 2 not begun")
        ended = run(MERGE)
        self.assertEqual(ended.returncode, 3)
        self.holds(ended.stdout, "chain, ida: missing", "pendulum, ida: missing")
        self.assertNotIn("ida", {row["method"] for row in table("S/points.csv")})
        self.done(POINTS)
        self.check_as_one_process()

    def test_a_scene_without_a_reference_is_skipped_and_the_rest_goes_on(self):
        self.sweep(
            'scenes = [{ generator = "pendulum", until = [0.05, 1e9] }]\nmethods = ["verlet"]\n'
            "accuracies = [1e-2]\n[options]\nrepeats = 1\n"
        )
        self.done(REFERENCES)  # that there is none is known now
        self.holds(self.done(POINTS).stdout, "1 of 2 tasks are done, 1 are skipped")
        self.assertEqual(run(MERGE).returncode, 3)
        none, skipped = table("S/missing.csv")
        self.assertEqual((none["state"], skipped["state"]), ("no reference", "skipped"))
        self.assertIn("earlier end (--until)", none["cause"])
        self.assertEqual(len(table("S/fastest.csv")), 1)
        said = self.done("sweep status S").stdout
        self.holds(said, "1 without a reference", "1 tasks are skipped", "all is done")

    def test_what_failed_is_listed_with_its_cause_and_a_command_that_measures_it(self):
        scene = '[generator]\nkind = "orbit"\n'
        write("mine.toml", scene)
        self.sweep(
            'scenes = ["mine.toml"]\nuntil = 0.05\nmethods = ["verlet"]\naccuracies = [1e-2]\n'
            "[options]\nrepeats = 1\n"
        )
        self.done(REFERENCES)
        write("mine.toml", scene + "mass = 2\n")
        changed = run(POINTS)
        self.assertEqual(changed.returncode, 3)
        self.holds(changed.stderr, "mine, verlet", "its scene is", "instead of")
        self.holds(self.done("sweep status S").stdout, "failed: mine, verlet", "1 failed")
        self.assertEqual(run(MERGE).returncode, 3)
        (missing,) = table("S/missing.csv")
        self.assertEqual(missing["state"], "failed")
        self.assertIn("its scene is", missing["cause"])
        write("mine.toml", scene)
        again = subprocess.run(missing["command"], shell=True, capture_output=True, check=False)
        self.assertEqual(again.returncode, 0)
        self.done(MERGE)

    def test_points_wait_for_their_reference_and_one_that_is_gone_is_made_again(self):
        self.sweep(measured="")
        ended = run(POINTS)
        self.assertEqual(ended.returncode, 3)
        self.holds(ended.stdout, "0 of 8 tasks are done, 8 wait for a reference")
        self.assertEqual(self.measured(), {})
        self.done(REFERENCES)
        shutil.copy("S/pendulum/reference.json", "S/chain/reference.json")
        self.holds(run(POINTS).stdout, "4 of 8 tasks are done, 4 wait for a reference")
        self.done(REFERENCES)
        self.done(POINTS)
        self.check_as_one_process()

    def test_a_full_disk_is_said_and_nothing_is_half_written(self):
        self.sweep(measured="references")
        # Files may grow to 1 kB (of 512 bytes each in sh), but messages go through a pipe.
        full = ["bash", "-c", f"ulimit -f 1; exec {BIN}/{POINTS}"]
        ended = subprocess.run(full, capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 3)
        self.assertIn("cannot be written", ended.stderr)
        self.assertEqual(len(self.measured()), 2)
        # If not even that can be said, it ends in order all the same.
        silent = ["bash", "-c", f"exec 2>silent; ulimit -f 0; exec {BIN}/{POINTS} >/dev/null"]
        self.assertEqual(subprocess.run(silent, check=False).returncode, 3)
        self.done(POINTS)
        self.check_as_one_process()
