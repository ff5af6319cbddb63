"""Motions that a study kept: the rows of motions.csv, the files that they name and the energies."""

import math
import os
from dataclasses import dataclass, field

import h5py
import numpy as np

from measurements import BadInput, parse, read_rows

PHASES = ("all", "force", "stiffness", "factorization", "solve")
# Bytes of unpacked chunks: frames are read one by one, and a chunk may hold many.
CACHE = 1 << 26
# The columns of the energies and their significant digits in a page: of the total its small changes are shown.
ENERGIES = {"t": 7, "kinetic": 7, "potential": 7, "total": 17}


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


def to_digits(value, digits):
    """The number, rounded to this many significant digits; None for what is no number."""
    return float(f"{value:.{digits}g}") if math.isfinite(value) else None


def read_energies(directory):
    """The energies of motions_energy.csv, {file: {"t": [...], ...}}, to as many digits as a page
    needs and None for what is no number; of a missing table, none. Raises BadInput where it is
    broken."""
    path = os.path.join(directory, "motions_energy.csv")
    if not os.path.exists(path):
        return {}
    energies = {}
    for line, row in read_rows(path, ("file", *ENERGIES)):
        own = energies.setdefault(row["file"], {name: [] for name in ENERGIES})
        for name in ENERGIES:
            value = parse(path, line, row, name, False)
            own[name].append(to_digits(value, ENERGIES[name]))
    return energies


@dataclass
class MotionFile:
    """An open motion: its name in the folder, `times` [s] of its frames, its nodes, springs (m, 2)
    and faces (k, 3)."""

    name: str
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
        """A data set's rows of these frames, by frame and node. Raises BadInput where they are
        damaged."""
        data = self.file["VTKHDF"][name]
        try:
            parts = [data[frame * self.nodes : (frame + 1) * self.nodes] for frame in frames]
        except OSError as error:
            raise BadInput(f"{self.name} is no whole HDF5 file.") from error
        return np.stack(parts) if parts else np.empty((0, self.nodes, *data.shape[1:]))


def groups_of(root, name, size, nodes):
    """The cells of a kind, (count, size): nodes each, all of them the scene's. Raises BadInput for
    others."""
    if name not in root:
        return np.empty((0, size), int)
    cells = np.asarray(root[name]["Connectivity"], dtype=np.int64)
    if len(cells) % size or (len(cells) and not 0 <= cells.min() <= cells.max() < nodes):
        raise BadInput(f"its {name} do not fit its points")
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
            raise BadInput(f"{points} points do not fit {len(times)} frames")
        if not np.isfinite(times).all():
            raise BadInput("a time is no number")
        nodes = points // len(times)
        distances = root.get("PointData/distance_to_reference")
        if distances is not None and distances.shape != (points,):
            raise BadInput("its distances do not fit its points")
        cells = (
            groups_of(root, name, size, nodes) for name, size in (("Lines", 2), ("Polygons", 3))
        )
        return MotionFile(name, file, times, nodes, *cells)
    except (BadInput, OSError, LookupError, ValueError, TypeError, AttributeError) as error:
        if file:
            file.close()
        raise BadInput(f"{name} {what_is_wrong(path, error)}.") from error


def what_is_wrong(path, error):
    """Why a file is not read. A page is passed on and must not tell where its folder was, as the
    words of HDF5 do."""
    if isinstance(error, BadInput):
        return f"cannot be read: {error}"
    if not os.path.exists(path):
        return "is missing"
    if isinstance(error, PermissionError):
        return "may not be read"
    return "is no whole HDF5 file" if isinstance(error, OSError) else "does not hold a motion"
