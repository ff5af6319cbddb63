"""Programs in folders where results lie that they wrote before: spoiled ones, or without room or memory
to write them anew."""

import functools
import os
import resource
import subprocess
from pathlib import Path

from limited_run import environment_of
from random_scenes import spoiled
from studies import COMMANDS, SCENES, write_scenes


def earlier_results(programs, names, place):
    """The folders of `place` with what these programs wrote before, by program."""
    os.makedirs(place)
    write_scenes(place)
    for name in sorted(set(names) & set(COMMANDS)):
        # The folder is called as the sandbox's, as command lines are part of what is written.
        os.makedirs(os.path.join(place, "results"))
        argv = [os.path.join(programs, name), *COMMANDS[name].split()]
        subprocess.run(argv, cwd=place, timeout=60, check=False, capture_output=True)
        os.rename(os.path.join(place, "results"), os.path.join(place, name))
    return {name: os.path.join(place, name) for name in set(names) & set(COMMANDS)}


@functools.cache
def least_memory(program):
    """Bytes of address space, within 2 %, with which the program can at least print its help, and the
    most that it may take. It runs with one thread, as in the campaign: a thread of OpenBLAS that gets
    no memory asks for it without an end."""
    limit = resource.getrlimit(resource.RLIMIT_AS)[1]
    most = 4 << 30 if limit == resource.RLIM_INFINITY else limit
    low, high = 1 << 20, most
    while high > 1.02 * low:
        middle = int((low * high) ** 0.5)
        argv = ["prlimit", f"--as={middle}", "--", program, "--help"]
        done = subprocess.run(argv, env=environment_of("/tmp"), capture_output=True, check=False)
        low, high = (low, middle) if done.returncode == 0 else (middle, high)
    return high, most


def again(dice, program, options, sandbox):
    """The call of a program where its earlier results lie: arguments, what goes before
    the program, and what is scarce ("disk", "memory" or ""). One of the files may be spoiled."""
    write_scenes(sandbox.here)
    sandbox.inputs.update(SCENES)
    there = {option.name for option in options}
    more = [n for n in ("--resume", "--force") if n in there and dice.random() < 0.4]
    scarce = dice.choice(["", "disk", "memory"])
    before = []
    if scarce == "disk":  # writes beyond so many bytes of a file fail, as they do on a full disk
        before = ["prlimit", f"--fsize={round(2e4 * dice.random() ** 3)}", "--"]
    elif scarce == "memory":
        least, most = least_memory(program)
        size = min(round(least * dice.uniform(1.02, 3)), most)
        before = ["prlimit", f"--as={size}", "--"]
    elif dice.random() < 0.8:
        folder = os.path.join(sandbox.here, "results")
        path = Path(folder, dice.choice(sorted(os.listdir(folder))))
        if path.is_file():
            path.write_bytes(spoiled(dice, path.read_bytes()))
    sandbox.notice()
    command = COMMANDS[os.path.basename(program)]
    if scarce == "memory":  # HDF5 itself crashes where memory runs out
        command = command.replace(".vtkhdf", ".pc2")
    return command.split() + more, before, scarce
