"""Draws which method is the fastest on each of many scenes, at each accuracy.

Call: sweep.py DIR. Reads fastest.csv in DIR, and crossovers.csv and sweep.json if they exist. Reads
points.csv, its sidecar points.json and chart.json in the folder of each scene. Writes fastest.png
and fastest.svg to DIR.

A row is a scene, in the order of fastest.csv; at most MOST are drawn. A scene whose folder cannot
be read is left out and counted.
"""

import os
import sys

import scene_row
from crossover_sentences import sentences
from measurements import BadInput, interrupted_by
from names import one_line
from record import read_record
from style import use_style
from sweep_picture import Study, draw
from sweep_tables import read_crossovers, read_origin, read_scenes

MOST = 60


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
    """The rows of the first scenes that can be read, MOST of them, and how many before could not;
    raises BadInput where fastest.csv names a method that its scene's folder has no run of."""
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
    origin = read_origin(os.path.join(folder, "sweep.json"))
    rows, unreadable = read_rows(folder, path, scenes)
    processors = ", ".join(dict.fromkeys(row.processor for row in rows))
    return Study(
        rows,
        len(scenes),
        unreadable,
        sentences(crossovers),
        origin.is_work,
        origin.processor or processors,
        interrupted_by(path),
    )


def main(arguments):
    """Draws the picture into the folder; returns the exit status."""
    if len(arguments) != 1:
        print("Usage: sweep.py DIR", file=sys.stderr)
        return 2
    [folder] = arguments
    use_style()
    try:
        sheet = draw(read(folder))
    except BadInput as error:
        print(error, file=sys.stderr)
        return 2
    for extension in ("png", "svg"):
        sheet.save(os.path.join(folder, f"fastest.{extension}"))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
