"""Draws one motion by several methods at one step size: its path or shape, and its energy.

Call: motion.py VIEW SCENE H T OUT.png, with the step size H and the end T in seconds.

VIEW is phase (x against v / omega of one mass in 1D), path (one mass in the plane of its motion) or
cloth (the shape of a square cloth). The motion called exact is by kahan_li8 at H / 20.
build/bin/simulate must be there.
"""

import csv
import io
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.collections import LineCollection

from curves import EXACT_LOOK, draw_curves, draw_energy
from names import shown
from sheet import Sheet
from style import Look, assign_looks, use_style

SIMULATE = Path(__file__).absolute().parents[2] / "build/bin/simulate"
METHODS = ("explicit_euler", "symplectic_euler", "semi_implicit_euler", "implicit_euler", "verlet")
EXACT = "kahan_li8"
EXACT_STEPS = 20
EXACT_SAMPLES = 4

WIDTH, HEIGHT = 10.0, 5.1
TOP, SIDE = 0.8, 3.7
FARTHEST = 1.5
THREADS = 11


@dataclass(frozen=True)
class Run:
    """A motion: positions and velocities by time, node and axis, and the total energy by time."""

    name: str
    look: Look
    times: np.ndarray
    positions: np.ndarray
    velocities: np.ndarray
    energy: np.ndarray
    failed: bool


def call_simulate(*words):
    """Runs simulate; returns whether it reached the end, and what it printed."""
    done = subprocess.run([SIMULATE, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        sys.exit(done.stderr.strip())
    return done.returncode == 0, done.stdout


def method_looks():
    """The look of every method, as in the charts."""
    table = io.StringIO(call_simulate("--list-methods", "--csv")[1])
    rows = csv.DictReader(table)
    return assign_looks({row["name"]: (row["family"], row["stock_of"]) for row in rows})


def simulate(name, look, method, scene, h, every, until):
    """One run, sampled at the interval `every`."""
    with tempfile.TemporaryDirectory() as folder:
        path, energy = f"{folder}/path.csv", f"{folder}/energy.csv"
        run = ("--scene", scene, "--method", method, "--step-size", h, "--until", until)
        outputs = ("--trajectory", path, "--energy", energy, "--every", every)
        reached_end, _ = call_simulate(*run, *outputs)
        rows = np.loadtxt(path, delimiter=",", skiprows=1)
        total = np.loadtxt(energy, delimiter=",", skiprows=1)[:, 3]
    samples = rows.reshape(len(total), -1, rows.shape[1])
    positions, velocities = np.split(samples[:, :, 2:], 2, axis=2)
    return Run(name, look, samples[:, 0, 0], positions, velocities, total, not reached_end)


def draw_plane(sheet, runs, curves, words):
    """Curves around the origin of a plane; the axes reach little farther than the exact one."""
    axes = sheet.axes(0.75, TOP, SIDE, SIDE)
    reach = FARTHEST * np.linalg.norm(curves[0], axis=1).max()
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel=words[0])
    axes.set_ylabel(words[1], labelpad=0)
    draw_curves(axes, runs, curves, mark="o")


def draw_phase(sheet, runs):
    """x against v / omega, where the exact motion of a harmonic oscillator is a circle."""
    omega = np.abs(runs[0].velocities).max() / np.abs(runs[0].positions).max()
    curves = [np.hstack([run.positions[:, 1], run.velocities[:, 1] / omega]) for run in runs]
    draw_plane(sheet, runs, curves, ("x in m", "v / ω in m"))


def draw_path(sheet, runs):
    """The path of node 1 around node 0, in the plane of its first position and velocity."""
    arm = runs[0].positions[0, 1] - runs[0].positions[0, 0]
    speed = runs[0].velocities[0, 1]
    across = speed - arm * (arm @ speed) / (arm @ arm)
    plane = np.stack([arm / np.linalg.norm(arm), across / np.linalg.norm(across)], 1)
    curves = [(run.positions[:, 1] - run.positions[:, 0]) @ plane for run in runs]
    draw_plane(sheet, runs, curves, ("along the first radius in m", "across it in m"))


def draw_threads(axes, positions, look):
    """Some threads of a square cloth along both its sides, in an oblique view."""
    count = round(len(positions) ** 0.5)
    x, y, z = np.moveaxis(positions.reshape(count, count, 3), 2, 0)
    seen = np.stack([0.62 * y - 0.75 * x, z - 0.3 * y - 0.25 * x], 2)
    shown = np.linspace(0, count - 1, THREADS).round().astype(int)
    lines = [*seen[shown], *seen[:, shown].swapaxes(0, 1)]
    axes.add_collection(LineCollection(lines, colors=look.color, linewidths=0.6))


def draw_cloth(sheet, runs):
    """A panel for each run: its last shape over the exact one or, of a run that blew up, the first
    that is too large."""
    reach = FARTHEST * np.abs(runs[0].positions).max()
    for i, run in enumerate(sorted(runs, key=lambda run: run.failed)):
        too_large = np.abs(run.positions).max((1, 2)) > reach
        shown = np.argmax(too_large) if too_large.any() else -1
        axes = sheet.axes(0.1 + 1.7 * (i % 3), TOP + 0.38 + 2.07 * (i // 3), 1.6, 1.5)
        axes.set_axis_off()
        axes.set(xlim=(-0.9, 0.7), ylim=(-1.3, 0.2), aspect="equal")
        if not run.failed:
            draw_threads(axes, runs[0].positions[-1], EXACT_LOOK)
        draw_threads(axes, run.positions[shown], run.look)
        state = f"{'blowing up at ' if run.failed else ''}t = {run.times[shown]:g} s"
        axes.set_title(f"{run.name}\n{state}", size=9, color=run.look.text_color)


VIEWS = {"phase": draw_phase, "path": draw_path, "cloth": draw_cloth}


def main(view, scene, h, until, out):
    """Draws the picture."""
    use_style()
    looks, step, end = method_looks(), float(h), float(until)
    fine, every = step / EXACT_STEPS, step / EXACT_SAMPLES
    runs = [simulate("exact", EXACT_LOOK, EXACT, scene, fine, every, end)]
    runs += [simulate(name, looks[name], name, scene, step, step, end) for name in METHODS]
    sheet = Sheet(WIDTH, HEIGHT)
    title = f"{shown(scene)}: {len(METHODS)} methods at one step size, h = {h} s"
    exact = f"exact: {EXACT} at h / {EXACT_STEPS}"
    sheet.head(0.15, (0.25, 14, title), (0.54, 10, exact))
    VIEWS[view](sheet, runs)
    draw_energy(sheet.axes(5.9, TOP, WIDTH - 6.1, SIDE), runs)
    sheet.save(out)


if __name__ == "__main__":
    if len(sys.argv) != 6 or sys.argv[1] not in VIEWS:
        sys.exit("Usage: motion.py phase|path|cloth SCENE H T OUT.png")
    main(*sys.argv[1:])
