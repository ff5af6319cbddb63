"""Runs methods at one step size by simulate and reads their motions back."""

import csv
import io
import json
import math
import subprocess
import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from curves import EXACT_LOOK
from motion_files import MotionFile, open_motion
from style import Look, assign_looks

SIMULATE = Path(__file__).absolute().parents[2] / "build/bin/simulate"
# A run is called exact if its error at the end is at most this.
ACCURACY = "1e-8"
LONGEST_SEARCH = "60"  # [s]
# A curve of the exact motion has so many points for each of the others.
EXACT_SAMPLES = 4
# Frames of a motion, and frames times nodes.
FEWEST_FRAMES, MOST_FRAMES, MOST_POSITIONS = 20, 500, 6e5


class Refused(Exception):
    """The words of a program that refused its input."""


def call_simulate(*words):
    """Runs simulate; returns its exit status and what it printed and complained of. Raises Refused
    where it refuses its input or cannot work."""
    done = subprocess.run([SIMULATE, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        raise Refused(done.stderr.strip())
    return done.returncode, done.stdout, done.stderr.strip()


@dataclass(frozen=True)
class Drawn:
    """A scene: its argument of --scene, name, dimension, end [s], gravity [m/s²], number of nodes, and
    the number of its only node that is not pinned, or None."""

    argument: str
    name: str
    dimension: int
    until: float
    gravity: list
    nodes: int
    mass: int | None


def drawn_scene(folder, scene, until=None):
    """The scene of an argument of --scene, to another end where `until` [s] is given; its whole text
    goes into the folder on the way."""
    path = Path(folder, "scene.toml")
    call_simulate("--scene", scene, "--write-scene", path)
    with open(path, "rb") as file:
        content = tomllib.load(file)
    moving = [at for at, node in enumerate(content["nodes"]) if not node.get("pinned", False)]
    return Drawn(
        scene,
        content["name"],
        content["dimension"],
        float(until or content["until"]),
        content["gravity"],
        len(content["nodes"]),
        moving[0] if len(moving) == 1 else None,
    )


@dataclass
class Run:
    """A motion that simulate made.

    value: its step size [s]; sidecar: what simulate says of it; motion: the open file of its frames;
    energies: by name, at the frames [J]; velocities: those of the only mass (frames, axes) [m/s], or
    None; why: why it did not reach the end, else empty.
    """

    name: str
    method: str
    value: float
    look: Look
    sidecar: dict
    motion: MotionFile
    energies: dict
    velocities: np.ndarray | None
    why: str

    @cached_property
    def positions(self):
        """The positions (frames, nodes, 3) [m]."""
        return self.motion.positions(range(len(self.times)))

    @cached_property
    def broken_from(self):
        """The first frame in which each spring is broken, or the number of frames."""
        frames = range(len(self.times))
        found = self.motion.broken_from(frames)
        return np.full(len(self.motion.springs), len(frames)) if found is None else found

    @property
    def times(self):
        """The times [s] of the frames."""
        return self.motion.times

    @property
    def energy(self):
        """The total energy [J] at the frames."""
        return np.array(self.energies["total"])

    @property
    def failed(self):
        """Whether it did not reach the end."""
        return bool(self.why)


def method_looks(methods):
    """How each method is drawn, its family and its line of summary: {name: (look, family, line)}."""
    rows = csv.DictReader(io.StringIO(call_simulate("--list-methods", "--csv")[1]))
    known = {row["name"]: row for row in rows if row["name"] in methods}
    # The first colours, whatever place they have among all methods.
    looks = assign_looks({name: (known[name]["family"], "") for name in methods if name in known})
    return {name: (looks[name], known[name]["family"], known[name]["summary"]) for name in looks}


def sampling(drawn, step_size):
    """The time [s] between frames: the least multiple of the step size that makes few enough."""
    most = min(MOST_FRAMES, max(FEWEST_FRAMES, MOST_POSITIONS / drawn.nodes))
    return max(1, math.ceil(drawn.until / step_size / most)) * step_size


def run_of(folder, drawn, every, name, look, words):
    """The run that simulate makes by these words, with a frame `every` seconds."""
    motion, energy, path = (
        Path(folder, f"{name}{ending}") for ending in (".vtkhdf", "_energy.csv", "_path.csv")
    )
    outputs = ["--motion", motion, "--energy", energy]
    outputs += ["--trajectory", path] if drawn.mass is not None else []
    words = ["--scene", drawn.argument, "--until", repr(drawn.until), *words]
    status, _, complaint = call_simulate(*words, *outputs, "--every", repr(every), "--force")
    opened = open_motion(str(folder), motion.name)
    frames = len(opened.times)
    columns = np.loadtxt(energy, delimiter=",", skiprows=1, ndmin=2)[:frames].T.tolist()
    velocities = None
    if drawn.mass is not None:
        table = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
        velocities = table[table[:, 1] == drawn.mass][:frames, 2 + drawn.dimension :]
    sidecar = json.loads(Path(f"{motion}.json").read_text(encoding="utf-8"))
    return Run(
        name,
        sidecar.get("method", name),
        sidecar.get("value"),
        look,
        sidecar,
        opened,
        dict(zip(("t", "kinetic", "potential", "total"), columns)),
        velocities,
        complaint.removeprefix("simulate: ") if status else "",
    )


def exact_run(folder, drawn, every):
    """The run that is called exact, of the fastest method for a small error; None where none was
    found."""
    words = ("--accuracy", ACCURACY, "--time-limit", LONGEST_SEARCH)
    run = run_of(folder, drawn, every / EXACT_SAMPLES, "exact", EXACT_LOOK, words)
    return run if run.sidecar.get("is_reached") and not run.failed else None


def runs_of(folder, drawn, methods, step_size, every):
    """A run of each method at the step size (text) in s, as a list."""
    looks = method_looks(methods)
    runs = []
    for method in methods:
        words = ("--method", method, "--step-size", step_size)
        runs.append(run_of(folder, drawn, every, method, None, words))
        runs[-1].look = looks[method][0]
        runs[-1].value = float(step_size)
    return runs
