"""Motions that a study kept: the rows of motions.csv, the files that they name and the energies."""

import math
import os
from dataclasses import dataclass, field

import h5py
import numpy as np

from measurements import BadInput, parse, read_rows

PHASES = ("all", "force", "stiffness", "factorization", "solve")
# Bytes of unpacked chunks: frames are read one by one, of which a chunk may hold many.
CACHE = 1 << 26
ENERGIES = ("t", "kinetic", "potential", "total")


@dataclass(frozen=True)
class MotionRow:
    """One row of motions.csv; seconds: of the run by phase, or None."""

    file: str
    role: str
    method: str
    knob: str
    value: float
    outcome: str
    t_reached: float
    why: str
    seconds: dict | None = None


def read_motion_rows(directory):
    """The rows of motions.csv, the most telling first. Raises BadInput where it is broken."""
    path = os.path.join(directory, "motions.csv")
    texts = ("file", "role", "method", "knob", "outcome", "why")
    rows = []
    for line, row in read_rows(path, (*texts, "value", "t_reached")):
        numbers = {name: parse(path, line, row, name, False) for name in ("value", "t_reached")}
        rows.append(
            MotionRow(
                **{name: row[name] or "" for name in texts},
                **numbers,
                seconds=seconds_of(path, line, row),
            )
        )
    return rows


def seconds_of(path, line, row):
    """The seconds of a row by phase, None where they are not known; None without any."""
    columns = {"all": "seconds"} | {phase: f"seconds_{phase}" for phase in PHASES[1:]}
    seconds = {
        phase: parse(path, line, row, column, False) if column in row else math.nan
        for phase, column in columns.items()
    }
    if not any(map(math.isfinite, seconds.values())):
        return None
    return {phase: value if math.isfinite(value) else None for phase, value in seconds.items()}


def read_energies(directory):
    """The energies of motions_energy.csv, {file: {"t": [...], ...}}, None for what is no number; of
    a missing table, none. Raises BadInput where it is broken."""
    path = os.path.join(directory, "motions_energy.csv")
    if not os.path.exists(path):
        return {}
    energies = {}
    for line, row in read_rows(path, ("file", *ENERGIES)):
        own = energies.setdefault(row["file"], {name: [] for name in ENERGIES})
        for name in ENERGIES:
            value = parse(path, line, row, name, False)
            own[name].append(value if math.isfinite(value) else None)
    return energies


@dataclass
class MotionFile:
    """An open motion: `times` [s] of its frames, its nodes, springs (m, 2) and faces (k, 3)."""

    file: h5py.File
    times: np.ndarray
    nodes: int
    springs: np.ndarray = field(repr=False)
    faces: np.ndarray = field(repr=False)

    def positions(self, frames):
        """Positions (frames, nodes, 3) [m] of the frames of these numbers."""
        return self.rows("Points", frames)

    def distances(self, frames):
        """Distances (frames, nodes) [m] from the reference; None where the file has none."""
        name = "PointData/distance_to_reference"
        return self.rows(name, frames) if name in self.file["VTKHDF"] else None

    def rows(self, name, frames):
        """A data set's rows of these frames, by frame and node."""
        data = self.file["VTKHDF"][name]
        parts = [data[frame * self.nodes : (frame + 1) * self.nodes] for frame in frames]
        return np.stack(parts) if parts else np.empty((0, self.nodes, *data.shape[1:]))


def groups_of(root, name, size, nodes):
    """The cells of a kind, (count, size): nodes each, all of them the scene's. Raises ValueError
    for others."""
    if name not in root:
        return np.empty((0, size), int)
    cells = np.asarray(root[name]["Connectivity"], dtype=np.int64)
    if len(cells) % size or (len(cells) and not 0 <= cells.min() <= cells.max() < nodes):
        raise ValueError(f"{name} do not fit the points")
    return cells.reshape(-1, size)


def open_motion(directory, name):
    """The motion in a file of the folder. Raises BadInput where it cannot be read, or lies
    elsewhere."""
    path = os.path.join(directory, name)
    inside = os.path.realpath(path).startswith(os.path.realpath(directory) + os.sep)
    if not name or not inside:
        raise BadInput(f"{name or 'a motion without a name'} is no file of the folder.")
    file = None
    try:
        file = h5py.File(path, "r", rdcc_nbytes=CACHE)
        root = file["VTKHDF"]
        times = np.asarray(root["Steps/Values"], float).reshape(-1)
        points, columns = root["Points"].shape
        if not len(times) or not points or points % len(times) or columns != 3:
            raise ValueError(f"{points} points do not fit {len(times)} frames")
        if not np.isfinite(times).all():
            raise ValueError("a time is no number")
        nodes = points // len(times)
        distances = root.get("PointData/distance_to_reference")
        if distances is not None and distances.shape != (points,):
            raise ValueError("its distances do not fit its points")
        cells = (
            groups_of(root, name, size, nodes) for name, size in (("Lines", 2), ("Polygons", 3))
        )
        return MotionFile(file, times, nodes, *cells)
    except (OSError, LookupError, ValueError, TypeError, AttributeError) as error:
        if file:
            file.close()
        reason = " ".join(str(error).split())
        raise BadInput(f"{name} cannot be read: {reason}.") from error
