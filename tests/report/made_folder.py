"""Makes a folder as ./run report finds it, of a motion and measurements that formulas give: a sheet
(3D), a chain (2D) or a row (1D) that swings."""

import json
from pathlib import Path

import h5py
import numpy as np

import made_sweeps
from study_tables import write_table

OF_THE_POINT = "method knob value outcome t_reached".split()
ENERGY_COLUMNS = "file t kinetic potential total".split()
# The least error of a run's nodes at its end, as a part of the scene's size.
NOISE = 1e-3


class Sheet:
    """A square grid of nodes (3D) or a line of them (2D, 1D): where they are at rest, springs
    (m, 2) and faces (k, 3)."""

    def __init__(self, side, dimension, has_faces=True, has_springs=True):
        self.dimension = dimension
        number = np.arange(side * side if dimension == 3 else side)
        self.rest = np.zeros((len(number), 3))
        self.rest[:, 0] = (number % side) / max(1, side - 1)
        self.rest[:, 1] = (number // side) / max(1, side - 1)
        grid = number.reshape(-1, side)
        pairs = [np.stack([grid[:, :-1], grid[:, 1:]], -1), np.stack([grid[:-1], grid[1:]], -1)]
        self.springs = np.concatenate([pair.reshape(-1, 2) for pair in pairs])
        corners = [grid[:-1, :-1], grid[:-1, 1:], grid[1:, :-1], grid[1:, 1:]]
        halves = [np.stack([corners[k] for k in half], -1) for half in ((0, 1, 2), (2, 1, 3))]
        self.faces = np.concatenate([half.reshape(-1, 3) for half in halves])
        self.springs = self.springs[: None if has_springs else 0]
        self.faces = self.faces[: None if has_faces and dimension == 3 else 0]

    def motion(self, times):
        """Positions (frames, nodes, 3) [m] at the times: it swings, the first node stays."""
        x = self.rest[:, 0]
        swing = np.sin(4 * np.pi * times)[:, None]
        wave = 0.3 * swing * x + 0.05 * np.sin(9 * times[:, None] + 7 * x) * x
        positions = np.repeat(self.rest[None], len(times), 0)
        positions[:, :, {1: 0, 2: 1, 3: 2}[self.dimension]] += wave
        return positions


def spoiled(positions, times, error, generator, diverges):
    """The positions with an error that grows to this one, (frames, nodes, 3), as another run has;
    where the run diverges, without bound."""
    share = times / max(times[-1], 1e-300)
    noise = generator.standard_normal(positions.shape) * error
    growth = np.exp(30 * share) / np.exp(6) if diverges else share
    moving = positions.std(axis=0) > 0
    return positions + noise * growth[:, None, None] * moving


def write_vtkhdf(path, sheet, times, positions, distance):
    """Writes a motion as the study does: all frames of the points, the topology once; distance
    (frames, nodes) in m, or None in the reference's own file."""
    frames, nodes, _ = positions.shape
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = [2, 0]
        root.attrs.create("Type", b"PolyData", dtype=h5py.string_dtype("ascii", 8))
        options = {"compression": "lzf", "shuffle": True}
        root.create_dataset("Points", data=positions.reshape(-1, 3).astype("f4"), **options)
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = frames
        steps["Values"] = times
        steps["PointOffsets"] = np.arange(frames) * nodes
        root["Lines/Connectivity"] = sheet.springs.reshape(-1).astype("i8")
        root["Lines/Offsets"] = 2 * np.arange(len(sheet.springs) + 1)
        root["Polygons/Connectivity"] = sheet.faces.reshape(-1).astype("i8")
        root["Polygons/Offsets"] = 3 * np.arange(len(sheet.faces) + 1)
        data = root.create_group("PointData")
        velocity = np.gradient(positions, times, axis=0) if frames > 1 else 0 * positions
        data.create_dataset("velocity", data=velocity.reshape(-1, 3).astype("f4"), **options)
        if distance is not None:
            values = distance.reshape(-1).astype("f4")
            data.create_dataset("distance_to_reference", data=values, **options)


def write_strains(path, broken_from):
    """Adds strains to a motion that was written: zero, and NaN from these frames of the springs on,
    one for each spring."""
    with h5py.File(path, "r+") as file:
        root = file["VTKHDF"]
        frames, cells = len(root["Steps/Values"]), len(root["Polygons/Offsets"]) - 1
        strains = np.zeros((frames, len(broken_from) + cells), "f4")
        is_broken = np.arange(frames)[:, None] >= np.asarray(broken_from)
        strains[:, : len(broken_from)][is_broken] = np.nan
        root["CellData/strain"] = strains.reshape(-1)


def energies(name, times, error):
    """Rows of motions_energy.csv."""
    kinetic = 0.2 * np.cos(4 * np.pi * times) ** 2
    total = 0.2 * (1 + error * times)
    return [
        dict(zip(ENERGY_COLUMNS, (name, float(t), float(k), float(e - k), float(e))))
        for t, k, e in zip(times, kinetic, total)
    ]


def write_motions(folder, sheet, rows, frames, runs):
    """Writes the reference's motion and those of some points; the runs, most telling first."""
    (folder / "motions").mkdir(exist_ok=True)
    generator = np.random.default_rng(7)
    exact = made_sweeps.UNTIL * np.linspace(0, 1, frames)
    size = float(np.ptp(sheet.motion(exact).reshape(-1, 3), axis=0).max())
    displacement = displacement_of(sheet)
    good = (row for row in rows if row["outcome"] == "reached_end")
    best = min(good, key=lambda row: row["error_position"])
    chosen = [best, *kept(rows, best, runs)]
    table, energy = [], []
    for number, row in enumerate(chosen):
        name = f"motions/{row['method']}_{row['value']:g}.vtkhdf"
        until = row["t_reached"]
        times = exact[exact <= until]
        if frames > 1 and times[-1] < until:
            times = np.append(times, until)
        reference = sheet.motion(times)
        diverges = row["outcome"] == "diverged"
        positions, distance, largest = reference, None, ""
        if number:
            error = size * max(NOISE, row["error_position"] or 0)
            positions = spoiled(reference, times, error, generator, diverges)
            distance = np.linalg.norm(positions - reference, axis=-1)
            largest = float(distance.max() / displacement) if displacement else ""
        write_vtkhdf(folder / name, sheet, times, positions, distance)
        table.append(
            {key: row[key] for key in OF_THE_POINT}
            | {"file": name, "role": "run" if number else "reference", "frames": len(times)}
            | {"largest_distance": largest, "why": "fastest at 1e-2" if number else ""}
        )
        energy += energies(name, times, 0.3 * NOISE * number)
    write_table(folder / "motions.csv", table)
    write_table(folder / "motions_energy.csv", energy)
    origin = {"interrupted": None, "exit_status": 0, "version": "0.1.0"}
    origin |= {"until": made_sweeps.UNTIL, "displacement": displacement, "runs_left_out": 0}
    (folder / "motions.json").write_text(json.dumps(origin))


def kept(rows, best, runs):
    """The points that have a motion: every fourth failure, and points spread over the others."""
    failed = [row for row in rows if row["outcome"] == "diverged"][::4]
    good = [row for row in rows if row["outcome"] == "reached_end" and row is not best]
    places = np.linspace(0, len(good) - 1, max(1, runs - len(failed))).astype(int)
    return [*(good[place] for place in places[:2]), *failed, *(good[p] for p in places[2:])][:runs]


def displacement_of(sheet):
    """The largest displacement of a node from the start [m]."""
    positions = sheet.motion(made_sweeps.UNTIL * np.linspace(0, 1, 101))
    return float(np.linalg.norm(positions - positions[0], axis=-1).max())


def make_folder(
    folder, scene="made", side=12, frames=40, runs=6, dimension=3, has_faces=True, has_springs=True,
    has_motions=True,
):  # fmt: skip
    """Writes all files into the folder, which may be new."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    sheet = Sheet(side, dimension, has_faces, has_springs)
    counts = (len(sheet.rest), len(sheet.springs))
    rows = made_sweeps.write_study(folder, scene, dimension, *counts, displacement_of(sheet))
    if has_motions:
        write_motions(folder, sheet, rows, frames, runs)
