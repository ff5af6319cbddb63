#!/usr/bin/python3
"""Every program with less and less memory (ulimit -v), on a scene of medium size.

  tests/fuzz/fuzz_memory.py --bin build/bin --sizes 10 --jobs 2

Bisection finds the least address space in which a program prints its help, and the least in which
it does its work. Sizes between these are tried. A program must end with status 0, or with 2 or 3
and a sentence on memory with a number in it. Files must be whole or missing. Status 1: something
was found.
"""

import argparse
import concurrent.futures
import os
import re
import shutil
import sys
import tempfile

from limited_run import limit_this_process, run, spelled
from written_tables import faults

MEDIUM = b'until = 0.01\n[generator]\nkind = "cloth"\nnodes = 60\n'
COMMANDS = {
    "simulate": "--scene medium.toml --method implicit_euler --step-size 2e-3 --until 0.01"
    " --final results/f.csv"
    " --trajectory results/t.csv --every 2e-3",
    "equilibrium": "--scene steady.toml --final results/f.csv",
    "modes": "--scene medium.toml --out results --count 3",
    "work_precision": "--scene small.toml --methods verlet,ida --repeats 1 --until 0.005"
    " --out results",
    "convergence": "--scene small.toml --methods verlet,implicit_midpoint --until 0.005"
    " --out results",
    "stability_map": "--scene small.toml --methods verlet --columns 2 --amplitudes 0.1"
    " --until 0.005 --out results",
    "energy_drift": "--scene small.toml --methods verlet,hht --step-size 1e-4 --until 0.05"
    " --out results",
    "exchange": "--scene fpu --methods verlet --until 10 --h-omega 1 --out results",
    "local_global": "--nodes 40 --iterations 10 --repeats 1 --stiffnesses 300 --resolutions 21"
    " --swing 0.05 --until 0.05"
    " --out results",
    "scaling": "--scenes cloth --least-nodes 1000 --most-nodes 20000 --sizes 1 --out results",
    "crossover": "--nodes 6 --ratios 1,10 --methods verlet,ida --until 0.02 --repeats 1"
    " --out results",
    "stock_sundials": "--scene small.toml --methods ida --rtol 1e-3 --repeats 1 --until 0.005"
    " --out results",
    "solvers": "--scene steady.toml --repeats 1 --out results",
    "verdicts": "--seeds 1 --cells 64 --out results",
    "symmetric_roots": "--samples 10 --out results",
    "advise": "--scene medium.toml --accuracy 1e-3 --out results",
    "advice": "--cases 1 --first 11000000 --repeats 1 --reference-seconds 0.3 --out results",
}
SCENES = {
    "medium.toml": MEDIUM,
    "small.toml": MEDIUM.replace(b"60", b"8"),
    "steady.toml": MEDIUM.replace(b"60", b"20"),
}
MOST = 4 << 30  # bytes


def arguments_of(caller):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True, help="the folder of the programs")
    parser.add_argument("--programs", help="a,b,... (default: all)")
    parser.add_argument("--sizes", type=int, default=10, help="how many sizes of memory")
    parser.add_argument("--jobs", type=int, default=1, help="programs at a time")
    a = parser.parse_args(caller)
    a.bin = os.path.abspath(a.bin)
    return a


def attempt(argv, place, size):
    """Runs with `size` bytes of address space in a folder of its own; the run, and faults of its
    files.
    """
    folder = tempfile.mkdtemp(dir=place)
    try:
        os.mkdir(os.path.join(folder, "results"))
        for name, data in SCENES.items():
            with open(os.path.join(folder, name), "wb") as file:
                file.write(data)
        environment = {
            "PATH": "/usr/bin:/bin",
            "LC_ALL": "C.UTF-8",
            "OMP_NUM_THREADS": "1",
            "OPENBLAS_NUM_THREADS": "1",
        }
        limited = ["/bin/sh", "-c", f'ulimit -v {size // 1024} && exec "$0" "$@"'] + argv
        ended = run(limited, folder, environment, 20, 60)
        results = os.path.join(folder, "results")
        return ended, list(faults(results, os.listdir(results)))
    finally:
        shutil.rmtree(folder)


def least(argv, place, low, high):
    """The least size in bytes, within 2 %, above which the command ends with status 0; None if
    there is none.
    """
    if attempt(argv, place, high)[0].status != 0:
        return None
    while high > 1.02 * low:
        middle = int((low * high) ** 0.5)
        if attempt(argv, place, middle)[0].status == 0:
            high = middle
        else:
            low = middle
    return high


def wrong(program, ended, spoiled):
    """Sentences on what is wrong with a run that had little memory."""
    said = ended.err.decode(errors="replace").strip().split("\n")[-1]
    if ended.asked_to_end:
        yield f"no end in {ended.cpu:.0f} s of processor time; after SIGINT status {ended.status}"
    elif ended.status not in (0, 2, 3):
        yield f"status {ended.status}: {said[-200:]}"
    elif ended.status and (
        not said.startswith(program + ": ") or "memory" not in said or not re.search(r"\d", said)
    ):
        yield f"status {ended.status}, and no sentence on how much memory: {said[:200]}"
    yield from spoiled


def sweep(a, program, place):
    """Lines on one program: what it needs, how runs with less ended, what is wrong; and how much
    is.
    """
    argv = [os.path.join(a.bin, program)] + COMMANDS[program].split()
    bare = least(argv[:1] + ["--help"], place, 1 << 20, MOST)
    full = bare and least(argv, place, bare, MOST)
    if not full:
        ended = attempt(argv, place, MOST)[0]
        return [
            f"{program:<16} cannot be tried: status {ended.status}: {ended.err.decode(errors='replace')[-200:]}"
        ], 1
    sizes = [int(bare * (full / bare) ** ((k + 0.5) / a.sizes)) for k in range(a.sizes)]
    statuses, bad = {}, {}
    for size in sizes:
        ended, spoiled = attempt(argv, place, size)
        statuses[ended.status] = statuses.get(ended.status, 0) + 1
        for fault in wrong(program, ended, spoiled):
            bad.setdefault(re.sub(r"[\d.]+", "#", fault), []).append((size, fault))
    lines = [
        f"{program:<16}help needs {bare / 2**20:.0f} MB, the run {full / 2**20:.0f} MB; {a.sizes} sizes between: "
        f"statuses {statuses}, {sum(map(len, bad.values()))} faults"
    ]
    for cases in bad.values():
        lines += [
            f"    {len(cases)} x {cases[0][1]}",
            f"        ulimit -v {cases[0][0] // 1024}; {spelled([program] + argv[1:])}",
        ]
    return lines, sum(map(len, bad.values()))


def main(caller=None):
    a = arguments_of(caller)
    names = a.programs.split(",") if a.programs else sorted(COMMANDS)
    names = [
        name for name in names if name in COMMANDS and os.access(os.path.join(a.bin, name), os.X_OK)
    ]
    if not names:
        sys.exit(f"fuzz_memory: {a.bin}: no program of {', '.join(COMMANDS)} is there")
    limit_this_process()  # no core files
    place, found = tempfile.mkdtemp(prefix="fuzz_memory."), 0
    try:
        with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
            for lines, count in pool.map(lambda name: sweep(a, name, place), names):
                print("\n".join(lines), flush=True)
                found += count
    finally:
        shutil.rmtree(place, ignore_errors=True)
    print(f"{found} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
