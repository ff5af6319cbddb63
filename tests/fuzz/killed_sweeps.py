"""A sweep of which shards run at once, some of them twice, while processes are killed and files cut."""

import glob
import os
import random
import signal
import subprocess
import time
from pathlib import Path

from limited_run import run
from written_tables import is_time, rows_of

STUDY = """scenes = ["pendulum", { generator = "chain", nodes = [4, 8] }]
until = 0.05
methods = ["verlet", "implicit_euler", "blanes_moan4", "ida", "trapezoidal", "arkode_erk4"]
accuracies = [1e-2, 1e-5]
[options]
point-limit = 60
repeats = 1
"""
SHARDS = ("1/3", "2/3", "3/3", "1/1")
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
LONGEST = 120.0  # seconds of a stage
STAGES = ("references", "points")


class Sweep:
    """A planned sweep in a folder of its own."""

    def __init__(self, programs, place):
        self.program, self.folder = os.path.join(programs, "sweep"), os.path.join(place, "S")
        os.makedirs(place)
        study = Path(place, "study.toml")
        study.write_text(STUDY, encoding="utf-8")
        self.start("plan", study, "--out", self.folder).wait()

    def start(self, *words):
        """The program, running."""
        return subprocess.Popen([self.program, *words], **QUIET)

    def shard(self, stage, shard):
        return self.start("run", self.folder, "--stage", stage, "--shard", shard)

    def merge(self):
        """The end of the program that puts the points together."""
        words = ["merge", self.folder, "--no-pictures"]
        return run([self.program, *words], self.folder, os.environ, 600, 600)

    def points(self):
        """The rows of the whole sweep's points, measured times left out."""
        names, *rows = rows_of(os.path.join(self.folder, "points.csv"))
        return sorted([[x for n, x in zip(names, row) if not is_time(n)] for row in rows])

    def whole_tasks(self):
        """The files of tasks that are complete, and what they hold."""
        paths = glob.glob(os.path.join(self.folder, "tasks", "whole", "*"))
        return {path: Path(path).read_bytes() for path in paths}


def disturb(dice, processes, folder):
    """Cuts a file that a killed process left, kills the program that a shard runs, or signals a shard."""
    alive, what = [process for process in processes if process.poll() is None], dice.random()
    try:
        if what < 0.1:
            owned = tuple(f".{process.pid}.journal" for process in alive)
            left = glob.glob(os.path.join(folder, "tasks", "begun", "*.journal"))
            left = [path for path in left if not path.endswith(owned)]
            if left:
                path = dice.choice(left)
                os.truncate(path, dice.randrange(os.path.getsize(path) + 1))
        elif alive and what < 0.4:
            pid = dice.choice(alive).pid
            for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
                os.kill(int(child), signal.SIGKILL)
        elif alive:
            dice.choice(alive).send_signal(
                dice.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
            )
    except OSError:
        pass  # it is gone meanwhile


def stage_faults(dice, sweep, stage):
    """Runs a stage with disturbances until every shard has ended well; yields what is wrong."""
    processes, before = [sweep.shard(stage, shard) for shard in SHARDS], {}
    began = time.monotonic()
    while any(process.poll() != 0 for process in processes):
        time.sleep(dice.uniform(0, 0.15))
        now = sweep.whole_tasks()
        if any(now.get(path) != content for path, content in before.items()):
            yield "a whole task was changed or went"
        before = now
        if time.monotonic() - began < LONGEST / 2:
            disturb(dice, processes, sweep.folder)
        for i, process in enumerate(processes):
            if process.poll() not in (None, 0):
                processes[i] = sweep.shard(stage, SHARDS[i])
        if time.monotonic() - began > LONGEST:
            yield f"{stage} did not end"
            for process in processes:
                process.kill()
            return


class Sweeps:
    """Trials of a sweep, after one that nobody disturbs."""

    def __init__(self, programs, name, place):
        self.programs, self.place, self.argv = programs, os.path.join(place, name), [name]
        sweep = Sweep(programs, os.path.join(self.place, "undisturbed"))
        for stage in STAGES:
            sweep.shard(stage, "1/1").wait()
        self.first = sweep.merge()
        self.expected = self.first.status == 0 and sweep.points()

    def trial(self, seed):
        """The faults of one disturbed sweep."""
        dice, sweep = random.Random(seed), Sweep(self.programs, os.path.join(self.place, seed))
        found = {fault for stage in STAGES for fault in stage_faults(dice, sweep, stage)}
        if (status := sweep.merge().status) != 0:
            found.add(f"merge: status {status}")
        elif sweep.points() != self.expected:
            found.add("points differ")
        if left := os.listdir(os.path.join(sweep.folder, "tasks", "begun")):
            found.add(f"begun tasks are left: {left}")
        return sorted(found)
