"""The motions of a page: what of the files in motions/ it holds, in how many bytes."""

import json
import math
import os
from dataclasses import dataclass

from answers import knob_in_words
from budget import fit
from encoding import distances_blob, index_blob, positions_blob, quantised
from measurements import BadInput
from motion_box import box_of, unmoved
from motion_files import open_motion, read_energies, read_motion_rows
from study_folder import is_number, look, number_or_none, read_json

# What stands around a blob in the page.
FRAME_OF_BLOB = len('<script type="text/plain" id="p1000"></script>\n')


@dataclass(frozen=True)
class EncodedRun:
    """One run as the page has it: its entry in `runs` without the names of its blobs."""

    entry: dict
    positions: str
    distances: str | None

    @property
    def size(self):
        """How many bytes it takes."""
        parts = [json.dumps(self.entry), self.positions, self.distances or ""]
        return sum(len(part) + FRAME_OF_BLOB for part in parts)


def distance_unit(study, directory):
    """The largest displacement [m], by which distances are divided; None where it is not known or
    nothing moves."""
    sources = (
        read_json(os.path.join(directory, "motions.json")).get("displacement"),
        look(study.reference_file, "scales", "displacement"),
    )
    known = [value for value in map(number_or_none, sources) if value and value > 0]
    return known[0] if known else None


def is_of_another_study(study, origin):
    """Whether the motions, by their sidecar, were kept of another scene or to another end than the
    points."""
    pairs = (
        (look(origin, "scene", "hash"), look(study.sidecar, "scene", "hash")),
        (number_or_none(origin.get("until")), study.until),
    )
    return any(None not in pair and pair[0] != pair[1] for pair in pairs)


def missing_motions(origin):
    """Sentences on motions that the study itself did not keep, as their sidecar says."""
    notes = []
    if origin.get("interrupted"):
        notes.append(
            f"Keeping motions was interrupted by {origin['interrupted']}: some are missing."
        )
    more = origin.get("runs_left_out")
    if is_number(more) and more > 0:
        notes.append(f"There was no room in motions/ for {more:g} more runs.")
    return notes


def open_all(directory, rows):
    """The rows with their open files, and a sentence for each file that cannot be shown."""
    opened, notes = [], []
    for row in rows:
        try:
            motion = open_motion(directory, row.file)
        except BadInput as error:
            notes.append(f"{error} It is not shown.")
            continue
        if opened and motion.nodes != opened[0][1].nodes:
            motion.file.close()
            notes.append(f"{row.file} has other nodes than {opened[0][0].file}. It is not shown.")
            continue
        opened.append((row, motion))
    return opened, notes


class Encoder:
    """Makes entries of a page's `motion` out of open files."""

    def __init__(self, study, opened, energies):
        self.opened = opened
        self.energies = energies
        self.box = box_of([motion for _, motion in opened])
        self.unit = distance_unit(study, study.directory)
        methods = list(dict.fromkeys(run.method for run in study.runs))
        self.methods = {name: index for index, name in enumerate(methods)}
        self.points = {}
        for index, run in enumerate(study.runs):
            self.points.setdefault((run.method, run.knob, run.value), index)

    def entry(self, row, motion, frames):
        """What the page says of a run beside its blobs."""
        label = row.method or row.role
        if math.isfinite(row.value):
            label += f" at {knob_in_words(row.knob, row.value)}"
        return {
            "role": "reference" if row.role == "reference" else "run",
            "point": self.points.get((row.method, row.knob, row.value)),
            "method": self.methods.get(row.method),
            "label": label,
            "why": row.why,
            "outcome": row.outcome,
            "t_reached": row.t_reached if math.isfinite(row.t_reached) else None,
            "times": motion.times[list(frames)].tolist(),
            "energy": self.energies.get(row.file),
            "seconds": row.seconds,
        }

    def encode(self, run, frames):
        """A run at the frames of these numbers."""
        row, motion = self.opened[run]
        steps, left_box = quantised(motion.positions(frames), self.box.low, self.box.size)
        distances = motion.distances(frames) if self.unit and row.role != "reference" else None
        return EncodedRun(
            self.entry(row, motion, frames) | {"left_box": left_box},
            positions_blob(steps),
            None if distances is None else distances_blob(distances / self.unit),
        )


def pack(study, opened, energies, room):
    """The page's `motion` and its blobs; without a motion, a sentence on why there is none."""
    first = opened[0][1]
    encoder = Encoder(study, opened, energies)
    blobs = {"s0": index_blob(first.springs)}
    if len(first.faces):
        blobs["f0"] = index_blob(first.faces)
    room -= sum(map(len, blobs.values()))
    pinned = unmoved(first)
    room -= len(json.dumps(pinned))
    counts = [len(motion.times) for _, motion in opened]
    runs = fit(counts, room, encoder.encode)
    if runs is None:
        return (
            None,
            {},
            ["The motions are too large for this page; the files in motions/ hold them."],
        )
    entries = []
    for number, run in enumerate(runs):
        blobs[f"p{number}"] = run.positions
        names = {"positions": f"p{number}", "distances": None}
        if run.distances is not None:
            names["distances"] = f"d{number}"
            blobs[f"d{number}"] = run.distances
        entries.append(run.entry | names)
    dimension = look(study.sidecar, "scene", "dimension")
    part = {
        "dimension": dimension if dimension in (1, 2, 3) else 3,
        "nodes": first.nodes,
        "springs": "s0",
        "faces": "f0" if "f0" in blobs else None,
        "pinned": pinned,
        "low": encoder.box.low.tolist(),
        "size": encoder.box.size,
        "distance_unit": encoder.unit,
        "notes": what_was_left_out(opened, entries),
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
        energies, more = energies_or_note(study.directory)
        notes += missing_motions(origin) + more
        if not opened:
            return None, {}, notes
        part, blobs, more = pack(study, opened, energies, room)
        if part is None:
            return None, {}, notes + more
        # What is missing of the motions is said beside them.
        return part | {"notes": notes + part["notes"]}, blobs, []
    except (BadInput, OSError, ValueError) as error:
        reason = " ".join(str(error).split()).removesuffix(".")
        return None, {}, [*notes, f"The motions cannot be shown: {reason}."]
    finally:
        for _, motion in opened:
            motion.file.close()


def energies_or_note(directory):
    """The energies over time, and a sentence where their table is broken."""
    try:
        return read_energies(directory), []
    except BadInput as error:
        return {}, [f"{error} The motions are shown without energies."]
