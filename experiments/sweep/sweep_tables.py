"""Reads what a sweep over many scenes wrote: fastest.csv, crossovers.csv and sweep.json."""

import json
import math
import os
from dataclasses import dataclass

from measurements import BadInput, parse, read_rows
from record import FrontPoint
from scene_row import accuracy_key

JUDGES = ("position", "energy")


@dataclass
class Scene:
    """The rows of one scene: its folder's name, what its errors are of, the accuracies, the fastest
    points and how many times as long the next methods take, by accuracy, and where each point
    stands in the file."""

    folder: str
    judge: str
    accuracies: list
    front: dict
    margins: dict
    lines: dict


@dataclass(frozen=True)
class Crossover:
    """The fastest method changes between two values of what is varied, at about `crossing`; None
    where that is not known."""

    along: str
    accuracy: float
    low: float
    high: float
    crossing: float | None
    scenes: tuple
    methods: tuple


@dataclass(frozen=True)
class Origin:
    """Where times come from: whether they are work times costs, and the processor, if it is
    said."""

    is_work: bool
    processor: str | None


def read_scenes(path):
    """The scenes of fastest.csv in its order."""
    scenes = {}
    for line, row in read_rows(
        path, ("scene", "accuracy", "method", "error", "time_s", "margin", "judged_by")
    ):
        folder, judge = row["scene"] or "", row["judged_by"]
        if not folder or os.path.basename(folder) != folder:
            raise BadInput(f"{path}, line {line}: scene is {folder!r}, not a folder's name.")
        if judge not in JUDGES:
            raise BadInput(f"{path}, line {line}: judged_by is {judge!r}, not position or energy.")
        scene = scenes.setdefault(folder, Scene(folder, judge, [], {}, {}, {}))
        if judge != scene.judge:
            raise BadInput(f"{path}, line {line}: {folder} is judged by position and by energy.")
        add_row(path, line, row, scene)
    if not scenes:
        raise BadInput(f"{path} has no rows.")
    return list(scenes.values())


def add_row(path, line, row, scene):
    """Adds the cell of one row of fastest.csv to its scene."""
    accuracy = parse(path, line, row, "accuracy", True)
    key = accuracy_key(accuracy)
    if key in scene.accuracies:
        raise BadInput(f"{path}, line {line}: {scene.folder} has its row at {key:g} already.")
    scene.accuracies.append(key)
    if not row["method"]:  # none reached the accuracy
        return
    time = parse(path, line, row, "time_s", True)
    scene.front[key] = FrontPoint(accuracy, row["method"], time)
    scene.lines[key] = line
    if (row["margin"] or "").strip():
        scene.margins[key] = parse(path, line, row, "margin", True)


def read_crossovers(path):
    """The rows of crossovers.csv; a file that is not there has none."""
    if not os.path.exists(path):
        return []
    texts = ("along", "scene_low", "scene_high", "method_low", "method_high")
    found = []
    for line, row in read_rows(path, (*texts, "accuracy", "low", "high", "crossing")):
        for name in texts:
            if not row[name]:
                raise BadInput(f"{path}, line {line}: {name} must not be empty.")
        low, high, crossing = (
            parse(path, line, row, name, False) for name in ("low", "high", "crossing")
        )
        if not -math.inf < low < high < math.inf:
            raise BadInput(f"{path}, line {line}: low and high must be numbers, the first less.")
        if crossing < low or crossing > high:
            raise BadInput(f"{path}, line {line}: crossing is not between low and high.")
        found.append(
            Crossover(
                row["along"],
                parse(path, line, row, "accuracy", True),
                low,
                high,
                None if math.isnan(crossing) else crossing,
                (row["scene_low"], row["scene_high"]),
                (row["method_low"], row["method_high"]),
            )
        )
    return found


def read_origin(path):
    """What sweep.json says of times; where it is not there, they were measured."""
    try:
        with open(path, encoding="utf-8") as file:
            about = json.load(file)
        times, processor = about.get("times", "measured"), about.get("processor")
    except FileNotFoundError:
        return Origin(False, None)
    except (OSError, ValueError, AttributeError) as error:
        raise BadInput(f"{path} cannot be read: {error}.") from error
    if times not in ("measured", "work"):
        raise BadInput(f"{path}: times is {times!r}, not measured or work.")
    return Origin(times == "work", str(processor) if processor else None)
