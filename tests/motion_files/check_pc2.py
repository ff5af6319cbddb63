#!/usr/bin/python3
"""Reads .pc2 files of simulate and the .obj beside them back, by struct alone.

Call: check_pc2.py --bin FOLDER.
"""

import json
import struct

import numpy as np

from motion_case import DIVERGING, FLOAT, assert_close, run_words, tried_place

HEADER = struct.Struct("<12siiffi")


def read_pc2(path):
    """The positions, samples x points x 3, of a whole file."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version, points, start, rate, samples = HEADER.unpack_from(data)
    assert (magic, version, start, rate) == (b"POINTCACHE2\0", 1, 0.0, 1.0)
    assert len(data) == HEADER.size + 12 * points * samples
    return np.frombuffer(data, "<f4", offset=HEADER.size).reshape(samples, points, 3)


def read_obj(path):
    """Vertices, and the corners of faces and edges counted from 0."""
    found = {"v": [], "f": [], "l": []}
    with open(path, encoding="ascii") as file:
        for line in file:
            kind, *words = line.split()
            if kind != "#":
                numbers = [float(word) if kind == "v" else int(word) - 1 for word in words]
                found[kind].append(numbers)
    return np.array(found["v"], "f4"), found["f"], found["l"]


def check_scene(place, name, faces, springs):
    """The samples against the table, the .obj against the first sample."""
    _, positions, _ = place.table_of(run_words(name, f"--motion {name}.pc2"))
    samples = read_pc2(place.path(name + ".pc2"))
    assert_close(samples, positions, FLOAT)
    vertices, found_faces, found_springs = read_obj(place.path(name + ".obj"))
    assert np.array_equal(vertices, samples[0])
    assert (len(found_faces), len(found_springs)) == (faces, springs)
    with open(place.path(name + ".pc2.json"), encoding="utf-8") as file:
        assert json.load(file)["outcome"] == "reached_end"
    return found_faces, found_springs


def check_failed_run(place):
    """A run that grows without bound leaves the samples that are numbers, and counts them."""
    _, positions, _ = place.table_of(f"{DIVERGING} --motion bad.pc2", status=3)
    samples = read_pc2(place.path("bad.pc2"))
    assert 1 < len(samples) <= len(positions) and np.isfinite(samples).all()
    assert_close(samples, positions[: len(samples)], FLOAT)


def check_accuracy(place):
    """An answer (--accuracy) writes a motion as well, from its start to its end."""
    words = "--scene oscillator --accuracy 1e-3 --until 0.5 --every 0.1 --motion a.pc2"
    _, positions, _ = place.table_of(words)
    assert len(positions) == 6
    assert_close(read_pc2(place.path("a.pc2")), positions, FLOAT)


def main():
    with tried_place(__doc__) as place:
        check_scene(place, "cloth", 32, 102)
        check_scene(place, "plane", 0, 3)
        assert check_scene(place, "massless", 0, 2) == ([], [[0, 1], [1, 2]])
        assert check_scene(place, "line", 0, 1) == ([], [[0, 1]])
        faces, springs = check_scene(place, "meshed", 2, 4)
        assert faces == [[0, 1, 2], [0, 2, 3]]
        assert sorted(map(sorted, springs)) == [[0, 1], [0, 3], [1, 2], [2, 3]]
        check_failed_run(place)
        check_accuracy(place)


if __name__ == "__main__":
    main()
