#!/usr/bin/python3
"""Kills every study at random moments, resumes it, and compares with a run that was never
disturbed.

  tests/fuzz/fuzz_kills.py --bin build/bin --kills 200 --jobs 2
  tests/fuzz/fuzz_kills.py --bin build/bin --kills 3 --study convergence,sweep

A trial sends SIGKILL, SIGINT or SIGTERM one to three times, at moments that are uniform in the
study's duration. Then it runs the same command with --resume until it ends. All columns but
measured times must be equal, to the digit; no .part file may be left at the end. After SIGINT and
SIGTERM the status is 130, all tables are whole, and each sidecar says "interrupted". Of a sweep,
several shards run at once while they, their programs and their files are disturbed. No complete task
may change meanwhile, and all points must be those of an undisturbed sweep. Status 1: something was
found.
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
from studies import LONG_STUDIES, REFERENCES_BY_THE_CLOCK, write_scenes
from written_tables import differences, faults, json_of


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
    parser.add_argument("--signals", default="KILL,KILL,INT,TERM", help="drawn from these")
    a = parser.parse_args(caller)
    a.bin, a.signals = os.path.abspath(a.bin), [
        signal.Signals["SIG" + name] for name in a.signals.split(",")
    ]
    return a


def files_in(folder):
    """The files of a folder with the times at which they were last written."""
    return {path: os.stat(path).st_mtime_ns for path in glob.glob(os.path.join(folder, "*"))}


class Study:
    """A study's command line, the folder of a run that was not disturbed, and how long that took."""

    def __init__(self, a, name, place):
        self.name, self.seed, self.signals = name, a.seed, a.signals
        self.place = os.path.join(place, name)
        self.argv = [os.path.join(a.bin, name)] + LONG_STUDIES[name].split() + ["--out", "results"]
        self.whole = os.path.join(self.place, "whole", "here", "results")
        first = self._run("whole", None, None)
        if name in REFERENCES_BY_THE_CLOCK and first.status == 0:
            shutil.copytree(self.whole, os.path.join(self.place, "again", "here", "results"))
            first = self._run("again", None, None)
        self.seconds, self.status, self.err = (
            first.wall,
            first.status,
            first.err.decode(errors="replace"),
        )

    def _run(self, where, stop_after, stop_signal, more=()):
        folder = os.path.join(self.place, where, "here")
        os.makedirs(folder, exist_ok=True)
        write_scenes(folder)
        stop = {"stop_after": stop_after, "stop_signal": stop_signal}
        return run(
            self.argv + list(more), folder, environment_of(folder), 600, 600, patience=10, **stop
        )

    def trial(self, number):
        """Faults of one trial and the seconds that all of its runs took."""
        dice, where = random.Random(f"{self.seed}/{self.name}/{number}"), f"trial{number}"
        results, found, spent, more = (
            os.path.join(self.place, where, "here", "results"),
            [],
            0.0,
            [],
        )
        if self.name in REFERENCES_BY_THE_CLOCK:
            self._take_references(results)
        for _ in range(dice.choice([1, 1, 2, 3])):
            which = dice.choice(self.signals)
            before = files_in(results)
            ended = self._run(where, dice.uniform(0, self.seconds), which, more)
            spent, more = spent + ended.wall, ["--resume"]
            if not ended.asked_to_end or ended.status == 0:
                break
            if which == signal.SIGKILL:
                continue
            if ended.status == -which and files_in(results) == before:
                continue  # the signal came before the program had begun
            if ended.status != 130:
                found.append(f"{which.name}: status {ended.status}, 130 is documented")
            names = os.listdir(results) if os.path.isdir(results) else []
            # A run removes the leftovers of an earlier kill when it first writes there, which this
            # one may not have come to.
            names = [
                n for n in names if not (n.endswith(".part") and os.path.join(results, n) in before)
            ]
            found += [f"after {which.name}: {fault}" for fault in faults(results, names)]
            found += [
                f"after {which.name}: {name} says nothing of it"
                for name in self._silent(results, names)
            ]
        last = self._run(where, None, None, ["--resume"])
        spent += last.wall
        if last.status != self.status:
            found.append(
                f"--resume: status {last.status}: {last.err.decode(errors='replace')[-200:]}"
            )
        elif not os.path.isdir(results):
            found.append("--resume: there are no results")
        else:
            found += faults(results, os.listdir(results))
            try:
                found += differences(self.whole, results)
            except ValueError:
                pass  # said above
        shutil.rmtree(os.path.join(self.place, where))
        return number, sorted(set(found)), spent

    def _take_references(self, results):
        for path in glob.glob(os.path.join(self.whole, "**", "reference.json"), recursive=True):
            to = os.path.join(results, os.path.relpath(path, self.whole))
            os.makedirs(os.path.dirname(to), exist_ok=True)
            shutil.copy(path, to)

    def _silent(self, results, names):
        for name in names:
            if name.endswith(".csv") and name[:-4] + ".json" in names:
                try:
                    if not json_of(os.path.join(results, name[:-4] + ".json")).get("interrupted"):
                        yield name[:-4] + ".json"
                except ValueError:
                    pass  # said as a fault


def campaign(a, name, place):
    """Prints a study's line and its findings; returns how many there are."""
    study = Study(a, name, place)
    if study.status != 0:
        print(f"{name:<16} cannot be tried: status {study.status}: {study.err[-200:]}")
        return 1
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        trials = list(pool.map(study.trial, range(a.first, a.first + a.kills)))
    bad = [trial for trial in trials if trial[1]]
    costs = sorted(spent / study.seconds for _, _, spent in trials)
    print(
        f"{name:<16}{study.seconds:>8.2f} s{len(trials):>8} trials{len(bad):>6} bad   killed and resumed over "
        f"undisturbed: median {costs[len(costs) // 2]:.2f}, at most {costs[-1]:.2f}",
        flush=True,
    )
    kinds = {}
    for number, found, _ in bad:
        for fault in found:
            kinds.setdefault(fault.split(":")[0], []).append((number, fault))
    for cases in kinds.values():
        print(
            f"    {len(cases)} x {cases[0][1]}\n        again: {sys.argv[0]} --bin {a.bin} --seed {a.seed} "
            f"--study {name} --first {cases[0][0]} --kills 1\n        {spelled([name] + study.argv[1:])}"
        )
    return len(bad)


def sweep_campaign(a, place):
    """The same of sweeps."""
    expected = killed_sweeps.undisturbed(a.bin, os.path.join(place, "undisturbed"))
    if isinstance(expected, str) or not expected:
        print(f"sweep            cannot be tried: {expected}")
        return 1
    bad = 0
    for number in range(a.first, a.first + a.kills):
        seed, folder = f"{a.seed}/{number}", os.path.join(place, f"sweep{number}")
        found = killed_sweeps.trial(a.bin, folder, seed, expected)
        bad += bool(found)
        for fault in found:
            print(
                f"    {fault}\n        again: {sys.argv[0]} --bin {a.bin} --seed {a.seed} "
                f"--study sweep --first {number} --kills 1"
            )
    print(f"sweep           {a.kills:>18} trials{bad:>6} bad of {len(expected)} points", flush=True)
    return bad


def main(caller=None):
    a = arguments_of(caller)
    limit_this_process()
    names = a.study.split(",") if a.study else [*sorted(LONG_STUDIES), "sweep"]
    present = [name for name in names if os.access(os.path.join(a.bin, name), os.X_OK)]
    if not present:
        sys.exit(f"fuzz_kills: {a.bin}: none of {', '.join(names)} is there")
    shared = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    place, started = tempfile.mkdtemp(prefix="fuzz_kills.", dir=shared), time.monotonic()
    try:
        bad = sum(
            sweep_campaign(a, place) if name == "sweep" else campaign(a, name, place)
            for name in present
        )
    finally:
        shutil.rmtree(place, ignore_errors=True)
    print(
        f"{bad} bad of {a.kills} trials of each of {len(present)} studies, {time.monotonic() - started:.0f} s"
    )
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
