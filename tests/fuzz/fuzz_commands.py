#!/usr/bin/python3
"""Random command lines of every program, each in a sandbox with limits: nothing may crash, hang or
lose.

  tests/fuzz/fuzz_commands.py --bin build/bin --count 100000 --jobs 2
  tests/fuzz/fuzz_commands.py --bin build/bin --seed 1 --only 4711   (one of them; its sandbox is kept)

Documented are the statuses 0, 2 (one sentence, no file written), 3 and, after a signal, 130.
Inputs and files of the user's stay as they are, tables are whole, no control character is printed.
A run that takes longer than the limit is sent SIGINT and must end in order. Some runs find results
that they wrote before, whole or spoiled, some of these with little memory or room for files. Status 1:
something was found.
"""

import argparse
import collections
import multiprocessing
import os
import random
import shutil
import sys
import tempfile
import time

from command_verdict import signature, verdict
from earlier_results import again, earlier_results
from limited_run import become_nobody, environment_of, limit_this_process, run, spelled
from random_commands import Commands, methods_of, options_of
from random_scenes import random_scene
from sandbox import Sandbox
from studies import COMMANDS

# How often each is drawn: what takes longer is drawn less.
DRAWN = {
    30: "simulate", 8: "equilibrium modes work_precision convergence stability_map energy_drift",
    6: "exchange", 5: "stock_sundials local_global", 4: "reversal crossover", 3: "advise",
    2: "solvers symmetric_roots sweep", 0.5: "scaling verdicts bench advice",
}  # fmt: skip
PROGRAMS = {name: often for often, names in DRAWN.items() for name in names.split()}
PROGRAMS |= {name: 1 for name in COMMANDS if name not in PROGRAMS}


def arguments_of(caller):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True, help="the folder of the programs")
    parser.add_argument("--count", type=int, default=10**9, help="how many runs")
    parser.add_argument("--seconds", type=float, default=10**9, help="for how long")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the number of the first run")
    parser.add_argument("--only", type=int, help="the number of the only run")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--programs", help="a,b,... (default: all)")
    parser.add_argument(
        "--memory", type=float, default=2, help="GB of address space that a run may take"
    )
    parser.add_argument(
        "--limit", type=float, default=1, help="s of processor time before a run is sent SIGINT"
    )
    a = parser.parse_args(caller)
    if a.only is not None:
        a.first, a.count, a.jobs = a.only, 1, 1
    return a


class Campaign:
    """All that is needed to do the run of a number, alone or among others."""

    def __init__(self, a):
        self.a, self.bin = a, os.path.abspath(a.bin)
        chosen = a.programs.split(",") if a.programs else list(PROGRAMS)
        self.names = [name for name in chosen if os.access(os.path.join(self.bin, name), os.X_OK)]
        if not self.names:
            sys.exit(f"fuzz_commands: {a.bin}: none of {', '.join(chosen)} is there")
        methods = methods_of(os.path.join(self.bin, "simulate"))
        self.commands = {
            name: Commands(name, options_of(os.path.join(self.bin, name)), methods)
            for name in self.names
        }
        place = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        self.place = tempfile.mkdtemp(prefix="fuzz_commands.", dir=place)
        os.chmod(self.place, 0o777)
        self.earlier = earlier_results(self.bin, self.names, os.path.join(self.place, "earlier"))

    def begin(self):
        """Takes rights and room from the process that does runs."""
        become_nobody(self.bin)
        limit_this_process(int(self.a.memory * 2**30), 64 * 2**20)

    def do(self, number):
        """The run of that number: program, arguments, how it ended and what is wrong with it."""
        dice = random.Random(f"{self.a.seed}/{number}")
        name = dice.choices(self.names, [PROGRAMS[n] for n in self.names])[0]
        arguments, files = self.commands[name].draw(dice), random_scene(dice)
        known = self.earlier.get(name)
        sandbox = Sandbox(os.path.join(self.place, f"run{number}"), files, known)
        program, before, scarce = os.path.join(self.bin, name), [], ""
        if known and dice.random() < 0.15:
            arguments, before, scarce = again(dice, program, self.commands[name].options, sandbox)
        try:
            argv, environment = [*before, program, *arguments], environment_of(sandbox.home)
            ended = run(argv, sandbox.here, environment, self.a.limit, 3 * self.a.limit)
            found = verdict(name, arguments, ended, sandbox, scarce)
        finally:
            if self.a.only is None:
                sandbox.remove()
        return number, name, arguments, ended, found


class Report:
    """The runs and the findings."""

    def __init__(self, a):
        self.a, self.statuses, self.found = a, collections.defaultdict(collections.Counter), {}
        self.counts, self.seconds = collections.Counter(), collections.Counter()

    def add(self, number, name, arguments, ended, found):
        self.statuses[name]["long" if ended.asked_to_end else ended.status] += 1
        self.seconds[name] += ended.wall
        for kind, detail in found:
            key = signature(name, kind, detail)
            self.counts[key] += 1
            if key not in self.found or len(arguments) < len(self.found[key][1]):
                self.found[key] = (number, arguments, detail)

    def print(self, seconds):
        columns = sorted({s for c in self.statuses.values() for s in c}, key=str)
        print(f"{'program':<16}{'runs':>8}" + "".join(f"{s:>8}" for s in columns) + "   ms a run")
        for name, counts in sorted(self.statuses.items()):
            cells = "".join(f"{counts[s]:>8}" for s in columns)
            total = sum(counts.values())
            print(f"{name:<16}{total:>8}{cells}{1e3 * self.seconds[name] / total:>11.0f}")
        programs = f" --programs {self.a.programs}" if self.a.programs else ""
        again = f"{sys.argv[0]} --bin {self.a.bin} --seed {self.a.seed}{programs} --only"
        for key, count in self.counts.most_common():
            number, arguments, detail = self.found[key]
            print(f"\n{count} x {key[0]}: {key[1]}\n    {detail.strip()[:300]!r}")
            print(f"    {spelled([key[0]] + arguments)[:1500]}\n    again: {again} {number}")
        print(f"\n{sum(self.counts.values())} findings of {len(self.counts)} kinds, {seconds:.0f} s")


def main(caller=None):
    a = arguments_of(caller)
    campaign, report, started = Campaign(a), Report(a), time.monotonic()
    try:
        with multiprocessing.get_context("fork").Pool(a.jobs, campaign.begin) as pool:
            for result in pool.imap_unordered(campaign.do, range(a.first, a.first + a.count)):
                report.add(*result)
                if time.monotonic() > started + a.seconds:
                    break
    except KeyboardInterrupt:
        print("interrupted")
    finally:
        if a.only is None:
            shutil.rmtree(campaign.place, ignore_errors=True)
        else:
            print(f"Its folder: {campaign.place}/run{a.only}")
    report.print(time.monotonic() - started)
    return 1 if report.counts else 0


if __name__ == "__main__":
    sys.exit(main())
