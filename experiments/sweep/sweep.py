"""Draws which method is the fastest on each of many scenes, at each accuracy.

Call: sweep.py DIR. Reads fastest.csv in DIR, and crossovers.csv and sweep.json if they exist. Reads
points.csv, its sidecar points.json and chart.json in the folder of each scene. Writes fastest.png
and fastest.svg to DIR.

A row is a scene, in the order of fastest.csv; at most MOST are drawn. A scene whose folder cannot
be read is left out and counted.
"""

import json
import math
import os
from dataclasses import dataclass

import measurements
import scene_row
from measurements import BadInput, interrupted_by, parse
from names import one_line
from record import FrontPoint, read_record
from sheet import main
from sweep_picture import Study, draw, sentences

MOST = 60
JUDGES = ("position", "energy")


@dataclass
class Scene:
    """The rows of one scene: its folder's name, the kind of its errors, accuracies. By accuracy:
    the fastest point, how many times as long the next method takes, and the line in the file."""

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


def read_scenes(path):
    """The scenes of fastest.csv in its order."""
    scenes = {}
    for line, row in measurements.read_rows(
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
        accuracy = parse(path, line, row, "accuracy", True)
        key = scene_row.accuracy_key(accuracy)
        if key in scene.accuracies:
            raise BadInput(f"{path}, line {line}: {folder} has its row at {key:g} already.")
        scene.accuracies.append(key)
        if not row["method"]:  # none reached the accuracy
            continue
        time = parse(path, line, row, "time_s", True)
        scene.front[key] = FrontPoint(accuracy, row["method"], time)
        scene.lines[key] = line
        if (row["margin"] or "").strip():
            scene.margins[key] = parse(path, line, row, "margin", True)
    if not scenes:
        raise BadInput(f"{path} has no rows.")
    return list(scenes.values())


def read_crossovers(path):
    """The rows of crossovers.csv; a file that is not there has none."""
    if not os.path.exists(path):
        return []
    texts = ("along", "scene_low", "scene_high", "method_low", "method_high")
    found = []
    for line, row in measurements.read_rows(path, (*texts, "accuracy", "low", "high", "crossing")):
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
    """What sweep.json says of times: whether they are work times costs, and the processor, if it is
    said. Where the file is not there, they were measured."""
    try:
        with open(path, encoding="utf-8") as file:
            about = json.load(file)
        times, processor = about.get("times", "measured"), about.get("processor")
    except FileNotFoundError:
        return False, None
    except (OSError, ValueError, AttributeError) as error:
        raise BadInput(f"{path} cannot be read: {error}.") from error
    if times not in ("measured", "work"):
        raise BadInput(f"{path}: times is {times!r}, not measured or work.")
    return times == "work", str(processor) if processor else None


def read_row(directory, scene):
    """The row of a scene; raises BadInput where its folder cannot be read."""
    record = read_record(directory)
    _, facts = scene_row.read_sidecar(os.path.join(directory, "points.json"))
    return scene_row.Row(
        one_line(scene.folder),
        **facts,
        **scene_row.of_record(record, scene.front),
        accuracies=tuple(scene.accuracies),
        margins=scene.margins,
        is_by_energy=scene.judge == "energy",
    )


def read_rows(folder, path, scenes):
    """The rows of the first scenes that can be read, MOST of them, and how many before could not.
    Raises BadInput where fastest.csv names a method of which its scene's folder has no run."""
    rows, unreadable = [], 0
    for scene in scenes:
        if len(rows) == MOST:
            break
        try:
            row = read_row(os.path.join(folder, scene.folder), scene)
        except BadInput:
            unreadable += 1
            continue
        for key, point in scene.front.items():
            if point.method not in row.kinds:
                raise BadInput(
                    f"{path}, line {scene.lines[key]}: {scene.folder} has no good run of"
                    f" {point.method}."
                )
        rows.append(row)
    if not rows:
        raise BadInput(f"{path}: no scene's folder can be read.")
    return rows, unreadable


def read(folder):
    """What is drawn of a folder."""
    path = os.path.join(folder, "fastest.csv")
    scenes = read_scenes(path)
    crossovers = read_crossovers(os.path.join(folder, "crossovers.csv"))
    is_work, processor = read_origin(os.path.join(folder, "sweep.json"))
    rows, unreadable = read_rows(folder, path, scenes)
    processors = ", ".join(dict.fromkeys(row.processor for row in rows))
    return Study(
        rows,
        len(scenes),
        unreadable,
        sentences(crossovers),
        is_work,
        processor or processors,
        interrupted_by(path),
    )


def draw_folder(folder):
    """Draws the picture into the folder."""
    draw(read(folder)).save_as(folder, "fastest")


if __name__ == "__main__":
    main(draw_folder)
