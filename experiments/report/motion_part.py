"""The motions of a page: what of the files in motions/ it holds, in how many bytes."""

import json
import math
import os
from dataclasses import dataclass

from budget import fit
from commands import study_options
from encoding import distances_blob, index_blob, positions_blob, quantised
from measurements import BadInput
from motion_box import against, box_of, unmoved
from motion_files import open_motion, read_energies, read_motion_rows
from study_folder import look, read_json

# Which runs are made, how often and for how long they may go on: another study has the same runs.
OF_THE_STUDY_ALONE = ("--methods", "--repeats", "--point-limit")
# The characters around a blob in the page.
FRAME_OF_BLOB = len('<script type="text/plain" id="p1000"></script>\n')


@dataclass(frozen=True)
class EncodedRun:
    """One run as the page has it: its entry in `runs` and its blobs by their names."""

    entry: dict
    blobs: dict

    @property
    def size(self):
        """How many bytes it takes."""
        entry = json.dumps(self.entry, separators=(",", ":"))
        return len(entry) + sum(len(blob) + FRAME_OF_BLOB for blob in self.blobs.values())


def run_options(sidecar):
    """The options of a sidecar's study that decide how each run goes; None where they are not
    known."""
    if not isinstance(look(sidecar, "study", "options"), dict):
        return None
    options = study_options(sidecar)
    return {name: value for name, value in options.items() if name not in OF_THE_STUDY_ALONE}


def is_of_another_study(study, origin):
    """Whether the motions, by their sidecar, were kept of another scene, to another end or with
    other options than the points."""
    pairs = (
        (run_options(origin), run_options(study.sidecar)),
        (look(origin, "scene", "hash"), look(study.sidecar, "scene", "hash")),
        (origin.get("until"), study.record.until),
    )
    return any(None not in pair and pair[0] != pair[1] for pair in pairs)


def missing_motions(origin):
    """Sentences on motions that the study itself did not keep, as their sidecar says."""
    notes = []
    if origin.get("interrupted"):
        notes.append(
            f"Keeping motions was interrupted by {origin['interrupted']}: some are missing."
        )
    if origin.get("runs_left_out"):
        notes.append(f"There was no room in motions/ for {origin['runs_left_out']} more runs.")
    return notes


def open_all(directory, rows):
    """The rows with their open files, and a sentence for each file that cannot be shown."""
    opened, notes = [], []
    for row in rows:
        try:
            motion = open_motion(directory, row["file"])
        except BadInput as error:
            notes.append(f"{error} It is not shown.")
            continue
        if opened and motion.nodes != opened[0][1].nodes:
            motion.file.close()
            other = opened[0][1].name
            notes.append(f"{motion.name} has other nodes than {other}. It is not shown.")
            continue
        opened.append((row, motion))
    return opened, notes


class Encoder:
    """Makes entries of a page's `motion` out of open files."""

    def __init__(self, study, origin, opened, energies):
        self.opened = opened
        self.energies = energies
        self.dimension = look(study.sidecar, "scene", "dimension") or 3
        self.pinned = unmoved(opened[0][1])
        self.mass = only_mass(opened[0][1].nodes, self.pinned)
        first_is_reference = opened[0][0]["role"] == "reference"
        self.low, self.size = box_of([motion for _, motion in opened], first_is_reference)
        # The largest displacement [m], by which distances are divided; None where it is not known
        # or nothing moves.
        known = look(study.reference, "scales", "displacement")
        self.unit = origin.get("displacement") or known or None
        self.knobs = [run.knob_words for run in study.runs]
        self.points = {}
        for index, run in enumerate(study.runs):
            self.points.setdefault((run.method, run.knob, run.value), index)

    def encode(self, run, frames):
        """A run at the frames of these numbers."""
        row, motion = self.opened[run]
        steps, left_box = quantised(motion.positions(frames), self.low, self.size)
        is_compared = self.unit and row["role"] != "reference"
        distances = motion.distances(frames) if is_compared else None
        point = self.points.get((row["method"], row["knob"], row["value"]))
        label = row["method"] or row["role"]
        times = motion.times[list(frames)].tolist()
        entry = {name: row[name] for name in ("why", "outcome", "t_reached", "seconds")}
        entry |= {
            "role": "reference" if row["role"] == "reference" else "run",
            "point": point,
            "label": label if point is None else f"{label} at {self.knobs[point]}",
            "times": times,
            "energy": told_energy(self.energies.get(row["file"]), times),
            "left_box": left_box,
            "positions": f"p{run}",
            "distances": None if distances is None else f"d{run}",
        }
        if self.mass is not None:
            entry["phase"] = self.phase(motion, frames)
        blobs = {f"p{run}": positions_blob(steps)}
        if distances is not None:
            blobs[f"d{run}"] = distances_blob(distances / self.unit)
        broken_from = motion.broken_from(frames)
        if broken_from is not None:
            entry["broken_from"] = f"b{run}"
            blobs[f"b{run}"] = index_blob(broken_from)
        return EncodedRun(entry, blobs)


    def phase(self, motion, frames):
        """The positions [m] and velocities [m/s] of the only mass, a list for each axis; None where
        the file has no velocities."""
        both = {"position": motion.positions(frames), "velocity": motion.velocities(frames)}
        if both["velocity"] is None:
            return None
        return {
            name: [few_digits(row) for row in values[:, self.mass].T[: self.dimension]]
            for name, values in both.items()
        }


def told_energy(energy, times):
    """The energies of a run, if there are any, without the potential, which is the total less the
    kinetic one, and without times that are those of the frames."""
    if energy is None:
        return None
    columns = ("kinetic", "total", "dissipated", "driven", "released")
    told = {name: energy[name] for name in columns if name in energy}
    is_at_frames = [float(f"{time:.7g}") for time in times] == energy["t"]
    return told if is_at_frames else told | {"t": energy["t"]}


def few_digits(values):
    """The numbers as floats of five digits; None for what is no number."""
    return [float(f"{one:.5g}") if math.isfinite(one) else None for one in values.tolist()]


def only_mass(nodes, pinned):
    """The number of the one node that moves; None where others do, too."""
    moving = set(range(nodes)) - set(pinned) if nodes - len(pinned) == 1 else ()
    return next(iter(moving), None)


def pack(study, origin, opened, energies, notes, room):
    """The page's `motion` with these notes, and its blobs; without a motion, all notes."""
    first = opened[0][1]
    encoder = Encoder(study, origin, opened, energies)
    blobs = {"s0": index_blob(first.springs)}
    if len(first.faces):
        blobs["f0"] = index_blob(first.faces)
    room -= sum(map(len, blobs.values()))
    room -= len(json.dumps(encoder.pinned))
    counts = [len(motion.times) for _, motion in opened]
    runs = fit(counts, room, encoder.encode)
    if runs is None:
        words = "The motions are too large for this page; the files in motions/ hold them."
        return None, {}, [*notes, words]
    for run in runs:
        blobs |= run.blobs
    entries = [run.entry for run in runs]
    part = {
        "dimension": encoder.dimension,
        # Against gravity; None where there is none.
        "up": against(look(study.sidecar, "scene", "gravity")),
        "nodes": first.nodes,
        "springs": "s0",
        "faces": "f0" if "f0" in blobs else None,
        "pinned": encoder.pinned,
        "low": encoder.low.tolist(),
        "size": encoder.size,
        "distance_unit": encoder.unit,
        # The relative distance below which the reference itself may be off.
        "known_to": origin.get("reference_error"),
        # Missing motions are named beside the others.
        "notes": notes + what_was_left_out(opened, entries) + what_breaks(entries),
        "runs": entries,
    }
    return part, blobs, []


def what_was_left_out(opened, entries):
    """A sentence on the runs and frames that the page does not hold; none where it has all."""
    all_frames = max(len(motion.times) for _, motion in opened)
    frames = max(len(entry["times"]) for entry in entries)
    parts = []
    if len(entries) < len(opened):
        parts.append(f"{len(entries)} of the {len(opened)} motions that were kept")
    if frames < all_frames:
        parts.append(f"{frames} of the {all_frames} frames of a motion")
    if not parts:
        return []
    return [
        f"To stay small, this page holds {' and '.join(parts)}; the files in motions/ hold all."
    ]


def what_breaks(entries):
    """A sentence on springs that break; none where the page has none."""
    is_any = any("broken_from" in entry for entry in entries)
    return ["Broken springs are not drawn."] if is_any else []


def motion_part(study, room):
    """The page's `motion` with its blobs {name: base64} in at most `room` bytes, and notes for the
    page's head; the motion is None where there is none."""
    if not os.path.exists(os.path.join(study.directory, "motions.csv")):
        return None, {}, []
    origin = read_json(os.path.join(study.directory, "motions.json"))
    if is_of_another_study(study, origin):
        return None, {}, ["The motions in this folder are of another study and are not shown."]
    notes, opened = [], []
    try:
        rows = read_motion_rows(study.directory)
        opened, notes = open_all(study.directory, rows)
        notes += missing_motions(origin)
        energies = {}
        try:
            energies = read_energies(study.directory)
        except BadInput as error:
            words = in_folder(error, study.directory)
            notes.append(f"{words} The motions are shown without energies.")
        if not opened:
            return None, {}, notes
        return pack(study, origin, opened, energies, notes, room)
    except BadInput as error:
        reason = in_folder(error, study.directory).removesuffix(".")
        return None, {}, [*notes, f"The motions cannot be shown: {reason}."]
    except (OSError, ValueError):
        return None, {}, [*notes, "The motions cannot be shown: a file in motions/ is broken."]
    finally:
        for _, motion in opened:
            motion.file.close()


def in_folder(error, directory):
    """The words of an error, in one line, in which files are named as seen from the folder."""
    return " ".join(str(error).replace(os.path.join(directory, ""), "").split())
