"""What a work-precision study left in its folder: its points, what is known of them and of the
reference."""

import json
import math
import os
from dataclasses import dataclass, replace

import measurements
import quantities

MACHINE_EPSILON = 2.0**-52


def look(content, *keys):
    """What lies at a path of keys in nested dicts; None where the path leads nowhere."""
    for key in keys:
        content = content.get(key) if isinstance(content, dict) else None
    return content


def is_number(value):
    """Whether a value of a JSON file is a finite number."""
    is_real = isinstance(value, (int, float)) and not isinstance(value, bool)
    return is_real and math.isfinite(value)


def number_or_none(value):
    """The number, or None for what is no finite number."""
    return value if is_number(value) else None


def read_json(path):
    """The dict that a JSON file holds; an empty one where there is no such file or it is broken."""
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
    except (OSError, ValueError, RecursionError):
        return {}
    return content if isinstance(content, dict) else {}


@dataclass(frozen=True)
class Study:
    """A folder's points.csv, row by row, and what stands beside it.

    rows: the cells of each row as texts; runs: the same with their position errors; sidecar and
    reference_file: the contents of points.json and reference.json; margins: how much the step of an
    accuracy's fastest run leaves to its limit, by the accuracy's digits, method and value.
    """

    directory: str
    columns: list
    rows: list
    runs: list
    sidecar: dict
    reference: measurements.Reference
    reference_file: dict
    interruption: object
    margins: dict

    @property
    def scene(self):
        """The scene's name, which may be any text."""
        names = (self.reference.scene, look(self.sidecar, "scene", "name"))
        texts = [name for name in names if isinstance(name, str) and name]
        folder = os.path.basename(os.path.abspath(self.directory))
        return (texts or [run.scene for run in self.runs if run.scene] or [folder])[0]

    @property
    def until(self):
        """The end of the motion in s; None where it is not known."""
        if self.reference.until is not None:
            return number_or_none(self.reference.until)
        return number_or_none(self.sidecar.get("until"))

    @property
    def method_notes(self):
        """What points.json says of each method: {name: {"summary": ..., "takes": [...]}}."""
        notes = self.sidecar.get("methods")
        return {
            note["name"]: note
            for note in (notes if isinstance(notes, list) else [])
            if isinstance(look(note, "name"), str)
        }

    @property
    def accuracies(self):
        """The accuracies that the study was asked for, from coarse to fine; none where it was asked
        for all."""
        words = look(self.sidecar, "study", "options", "--accuracies")
        try:
            asked = sorted({float(word) for word in words or ()}, reverse=True)
        except (TypeError, ValueError):
            return []
        return [accuracy for accuracy in asked if 0 < accuracy < 1]

    @property
    def judged_by(self):
        """Which error answers are judged by: "energy" where the end is beyond the horizon of a
        chaotic motion, else "position"."""
        return "energy" if self.reference.horizon is not None else "position"

    @property
    def certified(self):
        """The least error that can be told from zero; None where it is not known."""
        return MACHINE_EPSILON if self.judged_by == "energy" else self.reference.certified

    def judged_runs(self):
        """The runs with the error that they are judged by. A run that is another motion, by its
        modal shares, does not count."""
        if self.judged_by == "position":
            return self.runs
        return energy_runs(self.directory, self.columns, self.reference)


def energy_runs(directory, columns, reference):
    """The runs with their energy errors, each uncertain by one rounding."""
    path = os.path.join(directory, "points.csv")
    runs = measurements.read_runs(path, quantities.ENERGY.column)
    runs = [
        replace(run, known=(max(run.error - MACHINE_EPSILON, 0.0), run.error + MACHINE_EPSILON))
        for run in runs
    ]
    if quantities.MODES.column not in columns:
        return runs
    limit = quantities.MOST_OF_CHANCE * (reference.modal_floor or 0.0)
    shares = measurements.read_runs(path, quantities.MODES.column)
    return [replace(run, counts=not other.error > limit) for run, other in zip(runs, shares)]


def digits(accuracy):
    """How many decimal digits an accuracy means: 4 for 1e-4."""
    return round(-math.log10(accuracy))


def read_margins(path):
    """The stability margins of front.csv by the accuracy's digits, method and value of the knob;
    none where the file is not there. Raises BadInput where it is broken."""
    if not os.path.exists(path):
        return {}
    margins = {}
    for line, row in measurements.read_rows(path, ("accuracy", "method", "value")):
        if not row["method"] or not row.get("stability_margin"):
            continue
        cells = ("accuracy", "value", "stability_margin")
        accuracy, value, margin = (
            measurements.parse(path, line, row, cell, False) for cell in cells
        )
        if 0 < accuracy < math.inf:
            margins[digits(accuracy), row["method"], value] = margin
    return margins


def read_study(directory):
    """The study in a folder. Raises BadInput where points.csv is missing, or it or front.csv or
    reference.json is broken."""
    path = os.path.join(directory, "points.csv")
    columns = measurements.read_header(path)
    reference_path = os.path.join(directory, "reference.json")
    sidecar = read_json(os.path.join(directory, "points.json"))
    return Study(
        directory,
        columns,
        [row for _, row in measurements.read_rows(path, ("method",))],
        measurements.read_runs(path),
        sidecar,
        measurements.read_reference(reference_path),
        read_json(reference_path),
        sidecar.get("interrupted"),
        read_margins(os.path.join(directory, "front.csv")),
    )
