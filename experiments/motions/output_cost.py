#!/usr/bin/env python3
"""What the output of a motion costs: the bytes of the file, and the seconds that it adds to a run.

    /usr/bin/python3 experiments/motions/output_cost.py --out DIR

The scene is a square cloth of --nodes nodes a side, run by verlet. Each output has a frame at the
start and 100 later ones.
 1. Bytes are those of the file itself, of a run of 0.5 s with a frame every 5 ms. Sidecars, and the
    .xdmf or .obj beside a motion, are not counted.
 2. Seconds are those of a run of 100 steps with a frame each step, less those of the same run
    without output. They are medians of --repeats runs, the outputs by turns.
 3. Frames are packed on all cores while the run goes on. So output_cost.csv has the elapsed
    seconds, and beside them those of all cores together.
"""

import argparse
import csv
import os
import resource
import subprocess
import tempfile
import time
from statistics import median

COLUMNS = "output,bytes,seconds,processor_seconds,times_smaller,times_faster,cores".split(",")
STEP, FRAMES, UNTIL = 4e-4, 100, 0.5
SCENE = """until = 0.5
[generator]
kind = "cloth"
nodes = {}
structural_stiffness = 10.0
shear_stiffness = 5.0
bending_stiffness = 1.0
"""
# How each output is named in the table, its file, and the words that ask for it.
OUTPUTS = (
    ("trajectory", "t.csv", ("--trajectory",)),
    ("vtkhdf", "all.vtkhdf", ("--motion",)),
    ("vtkhdf_energy", "energy.vtkhdf", ("--motion-fields", "velocity,kinetic_energy", "--motion")),
    ("vtkhdf_positions", "none.vtkhdf", ("--motion-fields", "none", "--motion")),
    ("pc2", "cache.pc2", ("--motion",)),
)


def run(call):
    """The elapsed seconds of a command, and those of all cores together."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(call, stdout=subprocess.DEVNULL, check=True)
    elapsed, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return elapsed, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(options, folder):
    """The rows of the table."""
    scene = os.path.join(folder, "cloth.toml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(SCENE.format(options.nodes))
    call = [os.path.join(options.bin, "simulate"), "--progress", "none", "--scene", scene]
    call += ["--method", "verlet", "--step-size", str(STEP)]
    short = call + ["--until", str(FRAMES * STEP)]
    wanted = {name: [*words, os.path.join(folder, file)] for name, file, words in OUTPUTS}
    size, taken = {}, {name: [] for name in ("none", *wanted)}
    for name, words in wanted.items():
        run(call + words + ["--every", str(UNTIL / FRAMES)])
        size[name] = os.path.getsize(words[-1])
    for _ in range(options.repeats):
        taken["none"].append(run(short))
        for name, words in wanted.items():
            taken[name].append(run(short + words + ["--every", str(STEP)]))
    spent = {name: [median(column) for column in zip(*runs)] for name, runs in taken.items()}
    beyond = {name: [a - b for a, b in zip(spent[name], spent["none"])] for name in wanted}
    for name in wanted:
        smaller = size["trajectory"] / size[name]
        faster = beyond["trajectory"][0] / beyond[name][0]
        yield [name, size[name], *beyond[name], smaller, faster, os.cpu_count()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--out", required=True, help="the folder for output_cost.csv")
    parser.add_argument("--nodes", type=int, default=316, help="nodes along a side of the cloth")
    parser.add_argument("--repeats", type=int, default=3, help="how often each run is timed")
    built = os.environ.get("QDDOT_BIN", "build/bin")
    parser.add_argument("--bin", default=built, help="the folder of simulate")
    options = parser.parse_args()
    if options.nodes < 2 or options.repeats < 1:
        parser.error("--nodes is 2 or more, and --repeats 1 or more")
    os.makedirs(options.out, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=options.out) as folder:
        rows = list(measure(options, folder))
    with open(os.path.join(options.out, "output_cost.csv"), "w", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)


if __name__ == "__main__":
    main()
