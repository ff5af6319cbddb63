"""Reads .pc2 files of simulate and the .obj beside them back, by struct alone."""

import struct

import numpy as np

from motion_case import DIVERGING, FLOAT, Motions, assert_close, run_words
from programs import sidecar

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


class PointCaches(Motions):
    def faces_and_springs(self, name):
        """The cells of the .obj; samples are held against the table, vertices against the first."""
        _, positions, _ = self.table_of(run_words(name, f"--motion {name}.pc2"))
        samples = read_pc2(name + ".pc2")
        assert_close(samples, positions, FLOAT)
        vertices, faces, springs = read_obj(name + ".obj")
        assert np.array_equal(vertices, samples[0])
        self.assertEqual(sidecar(name + ".pc2.json")["outcome"], "reached_end")
        return faces, springs

    def test_scenes_of_every_kind(self):
        for name, faces, springs in ("cloth", 32, 102), ("plane", 0, 3):
            self.assertEqual(tuple(map(len, self.faces_and_springs(name))), (faces, springs))
        self.assertEqual(self.faces_and_springs("massless"), ([], [[0, 1], [1, 2]]))
        self.assertEqual(self.faces_and_springs("line"), ([], [[0, 1]]))
        faces, springs = self.faces_and_springs("meshed")
        self.assertEqual(faces, [[0, 1, 2], [0, 2, 3]])
        self.assertEqual(sorted(map(sorted, springs)), [[0, 1], [0, 3], [1, 2], [2, 3]])

    def test_a_run_that_grows_without_bound_leaves_the_samples_that_are_numbers(self):
        _, positions, _ = self.table_of(f"{DIVERGING} --motion bad.pc2", status=3)
        samples = read_pc2("bad.pc2")
        assert 1 < len(samples) <= len(positions) and np.isfinite(samples).all()
        assert_close(samples, positions[: len(samples)], FLOAT)

    def test_an_answer_writes_a_motion_from_its_start_to_its_end(self):
        words = "--scene oscillator --accuracy 1e-3 --until 0.5 --every 0.1 --motion a.pc2"
        _, positions, _ = self.table_of(words)
        self.assertEqual(len(positions), 6)
        assert_close(read_pc2("a.pc2"), positions, FLOAT)
