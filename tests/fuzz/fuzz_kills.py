#!/usr/bin/python3
"""Kills every study at random moments, resumes it, and compares with a run that was never
disturbed.

  tests/fuzz/fuzz_kills.py --bin build/bin --kills 200 --jobs 2
  tests/fuzz/fuzz_kills.py --bin build/bin --kills 3 --study convergence,sweep

A trial sends SIGKILL, SIGINT or SIGTERM one to three times, at moments that are uniform in the
study's duration. Then it runs the same command with --resume until it ends. All columns but
measured times must be equal, to the digit; no .part file may be left at the end. After SIGINT and
SIGTERM the status is 130, all tables are whole, and each sidecar says "interrupted". A sweep has
several shards that run at once; they, their programs and their files are disturbed. No complete
task may change meanwhile, and all points must be those of an undisturbed sweep. Status 1:
something was found.
"""

import argparse
import concurrent.futures
import glob
import os
import random
import shutil
import signal
import sys
import tempfile
import time

import killed_sweeps
from limited_run import environment_of, limit_this_process, run, spelled
from studies import LONG_STUDIES, REFERENCES_BY_THE_CLOCK, STUDIES, write_scenes
from written_tables import differences, faults, json_of

SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGINT, signal.SIGTERM)


def arguments_of(caller):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True, help="the folder of the programs")
    parser.add_argument("--kills", type=int, default=10, help="trials of each study")
    parser.add_argument("--study", help="a,b,... (default: all)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the number of the first trial")
    parser.add_argument("--jobs", type=int, default=1, help="trials at a time")
    a = parser.parse_args(caller)
    a.bin = os.path.abspath(a.bin)
    return a


def files_in(folder):
    """The files of a folder with the times at which they were last written."""
    return {path: os.stat(path).st_mtime_ns for path in glob.glob(os.path.join(folder, "*"))}


class Study:
    """A study's command line, the folder of a run that was not disturbed, and how long that took."""

    def __init__(self, programs, name, place):
        self.name, self.place = name, os.path.join(place, name)
        words = (LONG_STUDIES.get(name) or STUDIES[name]).split()
        self.argv = [os.path.join(programs, name), *words, "--out", "results"]
        self.whole = self._results("whole")
        self.first = self._run("whole")
        if name in REFERENCES_BY_THE_CLOCK and self.first.status == 0:
            shutil.copytree(self.whole, self._results("again"))
            self.first = self._run("again")

    def _results(self, where):
        return os.path.join(self.place, where, "here", "results")

    def _run(self, where, stop_after=None, stop_signal=None, more=()):
        folder = os.path.join(self.place, where, "here")
        os.makedirs(folder, exist_ok=True)
        write_scenes(folder)
        argv, environment = [*self.argv, *more], environment_of(folder)
        return run(argv, folder, environment, 600, 600, 10, stop_after, stop_signal)

    def trial(self, seed):
        """The faults of one trial."""
        dice, where, more = random.Random(f"{seed}/{self.name}"), f"trial{seed}", []
        results = self._results(where)
        found = []
        if self.name in REFERENCES_BY_THE_CLOCK:
            self._take_references(results)
        for _ in range(dice.choice([1, 1, 2, 3])):
            which, before = dice.choice(SIGNALS), files_in(results)
            ended = self._run(where, dice.uniform(0, self.first.wall), which, more)
            more = ["--resume"]
            if not ended.asked_to_end or ended.status == 0:
                break
            # A signal may come before the program has begun.
            is_early = ended.status == -which and files_in(results) == before
            if which != signal.SIGKILL and not is_early:
                found += self._disorder(ended.status, results, before)
        last = self._run(where, more=["--resume"])
        if last.status != self.first.status:
            said = last.err.decode(errors="replace")[-200:]
            found.append(f"--resume: status {last.status}: {said}")
        elif not os.path.isdir(results):
            found.append("--resume: there are no results")
        else:
            found += faults(results, os.listdir(results))
            try:
                found += differences(self.whole, results)
            except ValueError:
                pass  # said above
        shutil.rmtree(os.path.join(self.place, where))
        return sorted(set(found))

    def _take_references(self, results):
        for path in glob.glob(os.path.join(self.whole, "**", "reference.json"), recursive=True):
            to = os.path.join(results, os.path.relpath(path, self.whole))
            os.makedirs(os.path.dirname(to), exist_ok=True)
            shutil.copy(path, to)

    def _disorder(self, status, results, before):
        """Faults in what an interrupted run left."""
        if status != 130:
            yield f"interrupted: status {status}, 130 is documented"
        names = os.listdir(results) if os.path.isdir(results) else []
        # A run removes the leftovers of an earlier kill when it first writes there, which this one
        # may not have come to.
        names = {n for n in names if not n.endswith(".part") or f"{results}/{n}" not in before}
        for fault in faults(results, names):
            yield f"interrupted: {fault}"
        for name in sorted({f"{n[:-4]}.json" for n in names if n.endswith(".csv")} & names):
            try:
                if not json_of(os.path.join(results, name)).get("interrupted"):
                    yield f"interrupted: {name} says nothing of it"
            except ValueError:
                pass  # said as a fault


def main(caller=None):
    a = arguments_of(caller)
    limit_this_process()
    names = a.study.split(",") if a.study else [*sorted(LONG_STUDIES), "sweep"]
    names = [name for name in names if os.access(os.path.join(a.bin, name), os.X_OK)]
    if not names:
        sys.exit(f"fuzz_kills: {a.bin}: none of the studies is there")
    shared = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    place, started, bad = tempfile.mkdtemp(prefix="fuzz_kills.", dir=shared), time.monotonic(), 0
    try:
        for name in names:
            kind = killed_sweeps.Sweeps if name == "sweep" else Study
            study = kind(a.bin, name, place)
            if study.first.status != 0:
                said = study.first.err.decode(errors="replace")[-200:]
                print(f"{name:<16} cannot be tried: status {study.first.status}: {said}")
                bad += 1
                continue
            numbers = range(a.first, a.first + a.kills)
            with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
                trials = list(pool.map(study.trial, [f"{a.seed}-{number}" for number in numbers]))
            for number, found in zip(numbers, trials):
                bad += bool(found)
                again = f"{sys.argv[0]} --bin {a.bin} --seed {a.seed} --study {name}"
                for fault in found:
                    print(f"    {fault}\n        again: {again} --first {number} --kills 1")
            print(f"{spelled([name, *study.argv[1:]])}: {study.first.wall:.2f} s", flush=True)
    finally:
        shutil.rmtree(place, ignore_errors=True)
    spent = time.monotonic() - started
    print(f"{bad} bad of {a.kills} trials of each of {len(names)} studies, {spent:.0f} s")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
