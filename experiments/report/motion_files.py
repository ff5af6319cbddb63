"""Motions that a study kept: the rows of motions.csv, the files that they name and the energies."""

import os
from dataclasses import dataclass

import h5py
import numpy as np

from measurements import BadInput, read_rows
from study_folder import cell

# The columns of the seconds that a run spends in each phase.
PHASES = {"all": "seconds"}
PHASES |= {name: f"seconds_{name}" for name in ("force", "stiffness", "factorization", "solve")}
# Bytes of unpacked chunks: frames are read one by one, and a chunk may hold many.
CACHE = 1 << 26
# The columns of the energies and their significant digits in a page: of the total its small changes are shown.
ENERGIES = {"t": 7, "kinetic": 7, "potential": 7, "total": 17}
# Damped scenes have the energy that damping has taken, too, driven ones what driving has given, and
# those whose springs may break what they held.
WORK = {"dissipated": 17, "driven": 17, "released": 17}


def read_motion_rows(directory):
    """The rows of motions.csv by column, the most telling first; `seconds`: of the run by phase, or
    None. Raises BadInput where it is broken."""
    path = os.path.join(directory, "motions.csv")
    texts = ("file", "role", "method", "knob", "outcome", "why")
    rows = []
    for line, row in read_rows(path, (*texts, "value", "t_reached")):
        rows.append({name: row[name] or "" for name in texts})
        rows[-1] |= {name: cell(path, line, row, name) for name in ("value", "t_reached")}
        phases = {name: cell(path, line, row, column) for name, column in PHASES.items()}
        rows[-1]["seconds"] = phases if set(phases.values()) != {None} else None
    return rows


def read_energies(directory):
    """The energies of motions_energy.csv, {file: {"t": [...], ...}}, to as many digits as a page
    needs and None for what is no number; of a missing table, none. Raises BadInput where it is
    broken."""
    path = os.path.join(directory, "motions_energy.csv")
    if not os.path.exists(path):
        return {}
    energies = {}
    for line, row in read_rows(path, ("file", *ENERGIES)):
        columns = ENERGIES | {name: digits for name, digits in WORK.items() if name in row}
        own = energies.setdefault(row["file"], {name: [] for name in columns})
        for name, digits in columns.items():
            value = cell(path, line, row, name)
            own[name].append(None if value is None else float(f"{value:.{digits}g}"))
    return energies


@dataclass
class MotionFile:
    """An open motion: its name in the folder, `times` [s] of its frames, its nodes, springs (m, 2)
    and faces (k, 3)."""

    name: str
    file: h5py.File
    times: np.ndarray
    nodes: int
    springs: np.ndarray
    faces: np.ndarray

    def positions(self, frames):
        """Positions (frames, nodes, 3) [m] of the frames of these numbers."""
        return self.rows("Points", frames)

    def distances(self, frames):
        """Distances (frames, nodes) [m] from the reference; None where the file has none."""
        name = "PointData/distance_to_reference"
        return self.rows(name, frames) if name in self.file["VTKHDF"] else None

    def velocities(self, frames):
        """Velocities (frames, nodes, 3) [m/s]; None where the file has none."""
        name = "PointData/velocity"
        return self.rows(name, frames) if name in self.file["VTKHDF"] else None

    def broken_from(self, frames):
        """For each spring, the first place in `frames` (ascending numbers) at which it is broken,
        or their number where it never is; None where no spring breaks."""
        last = self.strains(frames[-1:])
        if last is None or not np.isnan(last).any():
            return None
        is_broken = np.isnan(self.strains(frames))
        return np.where(is_broken[-1], is_broken.argmax(axis=0), len(frames))

    def strains(self, frames):
        """Strains (frames, springs), NaN where a spring is broken; None where the file has none."""
        name = "CellData/strain"
        if name not in self.file["VTKHDF"]:
            return None
        strains = self.rows(name, frames)  # of vertices, springs and faces
        first = strains.shape[1] - len(self.springs) - len(self.faces)
        return strains[:, first : first + len(self.springs)]

    def rows(self, name, frames):
        """A data set's rows of these frames, by frame and node or cell. Raises BadInput where they
        are damaged."""
        data = self.file["VTKHDF"][name]
        count = len(data) // len(self.times)
        try:
            parts = [data[frame * count : (frame + 1) * count] for frame in frames]
        except OSError as error:
            raise BadInput(f"{self.name} is no whole HDF5 file.") from error
        return np.stack(parts) if parts else np.empty((0, count, *data.shape[1:]))


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
        for field, shape in (("distance_to_reference", (points,)), ("velocity", (points, 3))):
            data = root.get(f"PointData/{field}")
            if data is not None and data.shape != shape:
                raise BadInput(f"its {field} does not fit its points")
        kinds = (("Vertices", 1), ("Lines", 2), ("Polygons", 3))
        vertices, *cells = (groups_of(root, kind, size, nodes) for kind, size in kinds)
        strain = root.get("CellData/strain")
        count = sum(map(len, (vertices, *cells)))
        if strain is not None and strain.shape != (count * len(times),):
            raise BadInput("its strain does not fit its springs")
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
