"""Folders of results that studies wrote before, spoiled for the fuzzed studies to find."""

import os
import subprocess
from dataclasses import dataclass

from random_scenes import spoiled
from studies import SCENES, STUDIES, write_scenes


@dataclass
class Earlier:
    """A study's command line without --out, and the folder that it wrote."""

    arguments: list
    folder: str
    options: set

    def again(self, random):
        """The same command line into "results", perhaps to be resumed."""
        more = [
            name
            for name in ("--resume", "--force")
            if name in self.options and random.random() < 0.4
        ]
        return self.arguments + ["--out", "results"] + more


def earlier_results(programs, options, place):
    """Earlier results of studies by name, as folders of `place`; `options`: those of each program."""
    results = {}
    os.makedirs(place)
    write_scenes(place)
    for name in set(options) & set(STUDIES):
        arguments, folder = STUDIES[name].split(), os.path.join(place, name)
        # The folder is called as the sandbox's, as command lines are part of what is written.
        subprocess.run(
            [os.path.join(programs, name)] + arguments + ["--out", "results"],
            cwd=place,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=60,
            check=False,
        )
        if os.path.isdir(os.path.join(place, "results")):
            os.rename(os.path.join(place, "results"), folder)
            results[name] = Earlier(arguments, folder, {option.name for option in options[name]})
    return results


def spoil_one(random, sandbox):
    """Writes the scenes of the earlier results, and spoils one of these, mostly; both count as
    found.
    """
    write_scenes(sandbox.here)
    sandbox.inputs.update(SCENES)
    folder = os.path.join(sandbox.here, "results")
    chosen = random.choice(sorted(os.listdir(folder)))
    path = os.path.join(folder, chosen)
    if random.random() < 0.8 and os.path.isfile(path):
        with open(path, "rb") as file:
            data = file.read()
        with open(path, "wb") as file:
            file.write(spoiled(random, data))
    sandbox.notice()
