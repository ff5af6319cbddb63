#!/usr/bin/python3
"""Random command lines of every program, each in a sandbox with limits: nothing may crash, hang or
lose.

  tests/fuzz/fuzz_commands.py --bin build/bin --count 100000 --jobs 2
  tests/fuzz/fuzz_commands.py --bin build/bin --seed 1 --only 4711 --keep /tmp/kept   (one of them again)

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

from command_options import methods_of, options_of
from command_verdict import signature, verdict
from earlier_results import again, earlier_results
from limited_run import become_nobody, limit_this_process, run, spelled
from random_commands import Commands
from random_scenes import random_scene
from sandbox import Sandbox

# How often each is drawn: what takes longer is drawn less.
PROGRAMS = {
    "simulate": 30,
    "equilibrium": 8,
    "modes": 8,
    "work_precision": 8,
    "convergence": 8,
    "reversal": 4,
    "stability_map": 8,
    "energy_drift": 8,
    "exchange": 6,
    "stock_sundials": 5,
    "crossover": 4,
    "local_global": 5,
    "solvers": 2,
    "scaling": 0.5,
    "verdicts": 0.5,
    "symmetric_roots": 2,
    "bench": 0.5,
    "advise": 3,
    "advice": 0.5,
    "sweep": 2,
}


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
        "--keep", help="a folder for the sandboxes of what is found, as they were before"
    )
    parser.add_argument(
        "--memory", type=float, default=2, help="GB of address space that a run may take"
    )
    parser.add_argument(
        "--limit", type=float, default=1, help="s of processor time before a run is sent SIGINT"
    )
    a = parser.parse_args(caller)
    if a.only is not None:
        a.first, a.count, a.jobs = a.only, 1, 1
    if a.count == a.seconds == 10**9:
        parser.error("--count or --seconds is missing")
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
        options = {n: options_of(os.path.join(self.bin, n)) for n in self.names}
        self.commands = {n: Commands(n, options[n], methods) for n in self.names}
        place = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        self.place = tempfile.mkdtemp(prefix="fuzz_commands.", dir=place)
        os.chmod(self.place, 0o777)
        self.earlier = earlier_results(self.bin, options, os.path.join(self.place, "earlier"))

    def do(self, number):
        """The run of that number: program, arguments, how it ended and what is wrong with it."""
        dice = random.Random(f"{self.a.seed}/{number}")
        name = dice.choices(self.names, [PROGRAMS.get(n, 1) for n in self.names])[0]
        arguments, files = self.commands[name].draw(dice), random_scene(dice)
        root = os.path.join(self.place, f"run{number}")
        known = self.earlier.get(name)
        sandbox = Sandbox(root, files, known and known.folder)
        program, before, scarce = os.path.join(self.bin, name), [], ""
        if known and dice.random() < 0.15:
            arguments, before, scarce = again(dice, program, known, sandbox)
        if self.a.keep:
            kept = os.path.join(self.place, f"kept{number}")
            shutil.copytree(
                sandbox.here,
                kept,
                symlinks=True,
                ignore=lambda _, names: {"fifo", "locked.toml"} & set(names),
            )
        found = [("the fuzzer could not run it", "")]
        try:
            argv = [*before, program, *arguments]
            ended = run(argv, sandbox.here, sandbox.environment, self.a.limit, 3 * self.a.limit)
            found = verdict(name, arguments, ended, sandbox, scarce)
        finally:
            sandbox.remove()
            if self.a.keep and not found:
                shutil.rmtree(kept)
        return number, name, arguments, ended, found


def work(campaign, next_number, until, results):
    """Does runs until there are none left; sends each result."""
    become_nobody(campaign.bin)
    limit_this_process(int(campaign.a.memory * 2**30), 64 * 2**20)
    try:
        while time.monotonic() < until:
            with next_number.get_lock():
                number = next_number.value
                next_number.value += 1
            if number >= campaign.a.first + campaign.a.count:
                break
            results.put(campaign.do(number))
    except KeyboardInterrupt:
        pass  # the table is printed by the parent
    finally:
        results.put(None)


class Report:
    """What ran and what was found."""

    def __init__(self, a):
        self.a, self.statuses, self.found = a, collections.defaultdict(collections.Counter), {}
        self.counts, self.seconds = collections.Counter(), collections.Counter()

    def add(self, number, name, arguments, ended, found):
        if ended:
            self.statuses[name]["long" if ended.asked_to_end else ended.status] += 1
            self.seconds[name] += ended.wall
        for kind, detail in found:
            key = signature(name, kind, detail)
            self.counts[key] += 1
            if key not in self.found or len(arguments) < len(self.found[key][1]):
                self.found[key] = (number, arguments, detail)

    def print(self, seconds):
        runs = sum(sum(c.values()) for c in self.statuses.values())
        columns = sorted({s for c in self.statuses.values() for s in c}, key=str)
        print(f"{runs} runs in {seconds:.0f} s, seed {self.a.seed}")
        print(f"{'program':<16}{'runs':>8}" + "".join(f"{s:>8}" for s in columns) + "   ms a run")
        for name, counts in sorted(self.statuses.items()):
            total = sum(counts.values())
            print(
                f"{name:<16}{total:>8}"
                + "".join(f"{counts[s]:>8}" for s in columns)
                + f"{1e3 * self.seconds[name] / total:>11.0f}"
            )
        for key, count in self.counts.most_common():
            number, arguments, detail = self.found[key]
            print(
                f"\n{count} x {key[0]}: {key[1]}\n    {detail.strip()[:300]!r}\n    {spelled([key[0]] + arguments)[:1500]}"
                f"\n    again: {sys.argv[0]} --bin {self.a.bin} --seed {self.a.seed} --only {number}"
                + (f" --programs {self.a.programs}" if self.a.programs else "")
            )
        print(f"\n{sum(self.counts.values())} findings of {len(self.counts)} kinds")


def main(caller=None):
    a = arguments_of(caller)
    campaign, report, started = Campaign(a), Report(a), time.monotonic()
    if a.keep:
        os.makedirs(a.keep, exist_ok=True)
    try:
        next_number, results = multiprocessing.Value("q", a.first), multiprocessing.Queue()
        workers = [
            multiprocessing.Process(
                daemon=True, target=work, args=(campaign, next_number, started + a.seconds, results)
            )
            for _ in range(a.jobs)
        ]
        for worker in workers:
            worker.start()
        running = len(workers)
        while running:
            result = results.get()
            running -= result is None
            if result:
                report.add(*result)
                if a.keep and result[4]:
                    to = os.path.join(a.keep, f"kept{result[0]}")
                    shutil.rmtree(to, ignore_errors=True)
                    shutil.move(os.path.join(campaign.place, f"kept{result[0]}"), to)
    except KeyboardInterrupt:
        print("interrupted")
    finally:
        for worker in workers:
            worker.join(10)
        shutil.rmtree(campaign.place, ignore_errors=True)
    report.print(time.monotonic() - started)
    return 1 if report.counts else 0


if __name__ == "__main__":
    sys.exit(main())
