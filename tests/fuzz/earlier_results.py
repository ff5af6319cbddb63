"""Programs in folders where results lie that they wrote before: spoiled ones, or without room or memory
to write them anew."""

import functools
import os
import resource
import subprocess
from dataclasses import dataclass

from random_scenes import spoiled
from studies import COMMANDS, SCENES, write_scenes


@dataclass
class Earlier:
    """A program's arguments, the folder of results that it wrote, and its options' names."""

    arguments: list
    folder: str
    options: set


def earlier_results(programs, options, place):
    """Earlier results by program, as folders of `place`; `options`: those of each program."""
    results = {}
    os.makedirs(place)
    write_scenes(place)
    for name in sorted(set(options) & set(COMMANDS)):
        # The folder is called as the sandbox's, as command lines are part of what is written.
        os.makedirs(os.path.join(place, "results"))
        arguments, folder = COMMANDS[name].split(), os.path.join(place, name)
        argv = [os.path.join(programs, name), *arguments]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        subprocess.run(argv, cwd=place, timeout=60, check=False, **quiet)
        os.rename(os.path.join(place, "results"), folder)
        results[name] = Earlier(arguments, folder, {option.name for option in options[name]})
    return results


def most_memory():
    """Bytes of address space that a process started by this one may take."""
    limit = resource.getrlimit(resource.RLIMIT_AS)[1]
    return 4 << 30 if limit == resource.RLIM_INFINITY else limit


@functools.cache
def least_memory(program):
    """Bytes of address space, within 2 %, with which the program can at least print its help."""
    low, high = 1 << 20, most_memory()
    while high > 1.02 * low:
        middle = int((low * high) ** 0.5)
        argv = ["prlimit", f"--as={middle}", "--", program, "--help"]
        done = subprocess.run(argv, capture_output=True, check=False)
        low, high = (low, middle) if done.returncode == 0 else (middle, high)
    return high


def again(dice, program, earlier, sandbox):
    """What the program is to be called with where its earlier results lie: arguments, what goes before
    the program, and what is scarce ("disk", "memory" or ""). One of the files may be spoiled."""
    write_scenes(sandbox.here)
    sandbox.inputs.update(SCENES)
    more = [n for n in ("--resume", "--force") if n in earlier.options and dice.random() < 0.4]
    scarce = dice.choice(["", "disk", "memory"])
    before = []
    if scarce == "disk":  # writes beyond so many bytes of a file fail, as they do on a full disk
        before = ["prlimit", f"--fsize={round(2e4 * dice.random() ** 3)}", "--"]
    elif scarce == "memory":
        size = min(round(least_memory(program) * dice.uniform(1.02, 3)), most_memory())
        before = ["prlimit", f"--as={size}", "--"]
    elif dice.random() < 0.8:
        folder = os.path.join(sandbox.here, "results")
        path = os.path.join(folder, dice.choice(sorted(os.listdir(folder))))
        if os.path.isfile(path):
            with open(path, "r+b") as file:
                data = spoiled(dice, file.read())
                file.seek(0)
                file.truncate()
                file.write(data)
    sandbox.notice()
    return earlier.arguments + more, before, scarce
