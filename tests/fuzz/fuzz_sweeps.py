#!/usr/bin/python3
"""Kills the processes of sweeps at random moments until all is measured, and compares with a sweep
that was never disturbed.

  tests/fuzz/fuzz_sweeps.py --bin build/bin --trials 20 --seed 1

A trial runs several shards of a small study at once, some of them twice. It repeatedly sends
SIGKILL, SIGTERM or SIGINT to a shard, or SIGKILL to the program of a shard, or cuts a file that a
killed process left. Then it starts the shard again. No complete task may change or vanish
meanwhile. All points at the end must equal those of the undisturbed sweep, to the digit except for
measured times. No file of a begun task may be left. Status 1: something was found.
"""

import argparse
import csv
import glob
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

STUDY = """scenes = ["pendulum", { generator = "chain", nodes = [4, 8] }]
until = 0.05
methods = ["verlet", "implicit_euler", "blanes_moan4", "ida", "trapezoidal", "arkode_erk4"]
accuracies = [1e-2, 1e-5]
[options]
point-limit = 60
repeats = 1
"""
TIMES = ("time_s", "time_min_s", "setup_s", "timed_runs")
SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
LONGEST = 120.0  # seconds of a trial


def points_of(folder):
    """The rows of points.csv without measured times, in order."""
    with open(os.path.join(folder, "points.csv"), encoding="utf-8", newline="") as file:
        rows = [
            tuple(value for name, value in row.items() if name not in TIMES)
            for row in csv.DictReader(file)
        ]
    return sorted(rows)


def whole_files(folder):
    """The files of whole tasks and what they hold."""
    found = {}
    for path in glob.glob(os.path.join(folder, "tasks", "whole", "*")):
        with open(path, "rb") as file:
            found[path] = file.read()
    return found


def children_of(process):
    """The numbers of a process's children."""
    try:
        with open(f"/proc/{process.pid}/task/{process.pid}/children", encoding="utf-8") as file:
            return [int(word) for word in file.read().split()]
    except OSError:
        return []


class Sweep:
    """A planned sweep in a folder of its own."""

    def __init__(self, programs, place):
        self.program, self.folder = os.path.join(programs, "sweep"), os.path.join(place, "S")
        study = os.path.join(place, "study.toml")
        with open(study, "w", encoding="utf-8") as file:
            file.write(STUDY)
        self.call("plan", study, "--out", self.folder)

    def call(self, *words):
        """Runs the program to its end; returns its status."""
        return subprocess.run(
            [self.program, *words],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            check=False,
        ).returncode

    def start(self, stage, shard):
        """A shard, running."""
        words = ["run", self.folder, "--stage", stage, "--shard", shard]
        return subprocess.Popen(
            [self.program, *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )

    def merged(self):
        """The points of the whole sweep."""
        status = self.call("merge", self.folder, "--no-pictures")
        return points_of(self.folder) if status == 0 else f"merge: status {status}"


def disturb(dice, processes, folder):
    """One thing that goes wrong; how many processes it killed."""
    alive = [process for process in processes if process.poll() is None]
    what = dice.random()
    if what < 0.1:  # a file that a killed process left is cut; one that is at work is its own
        left = glob.glob(os.path.join(folder, "tasks", "begun", "*.journal"))
        owned = tuple(f".{process.pid}.journal" for process in alive)
        left = [path for path in left if not path.endswith(owned)]
        if left:
            path = dice.choice(left)
            try:
                os.truncate(path, dice.randrange(os.path.getsize(path) + 1))
            except OSError:  # it is gone meanwhile
                pass
        return 0
    if not alive:
        return 0
    victim = dice.choice(alive)
    if what < 0.4:
        for child in children_of(victim):
            try:
                os.kill(child, signal.SIGKILL)
            except ProcessLookupError:
                pass
        return 1
    victim.send_signal(dice.choice(SIGNALS))
    return 1


def run_stage(dice, sweep, stage, found):
    """Runs a stage with disturbances until every shard has ended well; how many it killed."""
    shards = [f"{number}/3" for number in (1, 2, 3)] + ["1/1"]
    processes = [sweep.start(stage, shard) for shard in shards]
    kills, before, began = 0, {}, time.monotonic()
    while True:
        time.sleep(dice.uniform(0, 0.15))
        for path, content in before.items():
            if whole_files(sweep.folder).get(path) != content:
                found.add("a whole task was changed or went")
        before = whole_files(sweep.folder)
        is_late = time.monotonic() - began > LONGEST / 2
        if not is_late:
            kills += disturb(dice, processes, sweep.folder)
        for i, process in enumerate(processes):
            if process.poll() not in (None, 0):
                processes[i] = sweep.start(stage, shards[i])
        if all(process.poll() == 0 for process in processes):
            return kills
        if time.monotonic() - began > LONGEST:
            found.add(f"{stage} did not end")
            for process in processes:
                process.kill()
            return kills


def trial(programs, expected, seed):
    """What one trial found and how many processes it killed."""
    dice, found = random.Random(seed), set()
    with tempfile.TemporaryDirectory(prefix="fuzz_sweeps.") as place:
        sweep = Sweep(programs, place)
        kills = sum(run_stage(dice, sweep, stage, found) for stage in ("references", "points"))
        points = sweep.merged()
        if points != expected:
            found.add(points if isinstance(points, str) else "points differ")
        left = os.listdir(os.path.join(sweep.folder, "tasks", "begun"))
        if left:
            found.add(f"begun tasks are left: {left}")
    return sorted(found), kills


def main(caller=None):
    """Runs the trials; returns the exit status."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True, help="the folder of the programs")
    parser.add_argument("--trials", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1, help="of the first trial")
    a = parser.parse_args(caller)
    programs = os.path.abspath(a.bin)
    with tempfile.TemporaryDirectory(prefix="fuzz_sweeps.") as place:
        whole = Sweep(programs, place)
        for stage in ("references", "points"):
            whole.call("run", whole.folder, "--stage", stage)
        expected = whole.merged()
    if isinstance(expected, str) or not expected:
        print(f"the undisturbed sweep failed: {expected}")
        return 1
    bad, kills = 0, 0
    for seed in range(a.seed, a.seed + a.trials):
        found, killed = trial(programs, expected, seed)
        kills += killed
        bad += bool(found)
        for fault in found:
            print(
                f"seed {seed}: {fault}\n    again: {sys.argv[0]} --bin {a.bin} --trials 1 --seed {seed}"
            )
    print(f"{a.trials} trials, {kills} kills, {bad} bad; {len(expected)} points each")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
