"""What a work-precision study left in its folder: its points, their record and what stands beside
them."""

import json
import math
import os
from dataclasses import dataclass

from measurements import parse, read_rows
from record import Record, read_record


def look(content, *keys):
    """What lies at a path of keys in nested dicts; None where the path leads nowhere."""
    for key in keys:
        content = content.get(key) if isinstance(content, dict) else None
    return content


def cell(path, line, row, column):
    """The number in a cell of a table; None where there is none, as in a column that is missing.
    Raises BadInput for a cell that is no number."""
    value = parse(path, line, row, column, False) if column in row else math.nan
    return value if math.isfinite(value) else None


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

    rows: the cells of each row as texts with the number of its line; sidecar and reference: the
    contents of points.json and reference.json.
    """

    directory: str
    rows: list
    record: Record
    sidecar: dict
    reference: dict

    @property
    def runs(self):
        """The runs with the errors that they are judged by."""
        return self.record.judged.runs

    @property
    def method_notes(self):
        """What points.json says of each method: {name: {"summary": ..., "takes": [...]}}."""
        return {look(note, "name"): note for note in self.sidecar.get("methods") or []}


def read_study(directory):
    """The study in a folder. Raises BadInput where points.csv or chart.json is missing or broken."""
    path = os.path.join(directory, "points.csv")
    return Study(
        directory,
        read_rows(path, ("method",)),
        read_record(directory),
        read_json(os.path.join(directory, "points.json")),
        read_json(os.path.join(directory, "reference.json")),
    )
