"""Runs of simulate on the scenes of the folder beside this, for a motion and its table, both read
back."""

import os
import shutil
import xml.etree.ElementTree as ElementTree
from itertools import islice
from pathlib import Path

import h5py
import numpy as np

from programs import Programs, read, run

# Half the spacing of 32-bit floats, relative: what rounding to them may change.
FLOAT = 2.0**-24
# Half the spacing of numbers with seven bits behind the first, and the rounding to 32 bits before.
SHORT = 2.0**-8 + FLOAT
SMALLEST = 2.0**-126  # below it 32-bit floats are spaced evenly

# A run that grows without bound.
DIVERGING = "--scene cloth.toml --method explicit_euler --step-size 1e-2 --until 50 --every 1e-2"


class Motions(Programs):
    """Each test stands in a fresh folder with the scenes."""

    def setUp(self):
        super().setUp()
        shutil.copytree(Path(__file__).with_name("scenes"), ".", dirs_exist_ok=True)

    def table_of(self, words, status=0):
        """Runs simulate for a motion and its table, which it reads."""
        ended = run(f"simulate {words} --trajectory t.csv --force")
        self.assertEqual(ended.returncode, status, ended.stderr)
        return table("t.csv")


def run_words(scene, more):
    """A short run that ends well."""
    return f"--scene {scene}.toml --method verlet --step-size 1e-4 --until 0.05 --every 0.01 {more}"


def table(path):
    """Times, positions and velocities (frames x nodes x 3, zero beyond the dimension) of a
    --trajectory."""
    lines = read(path).split()[1:]
    values = np.array([[float(field or "nan") for field in line.split(",")] for line in lines])
    nodes, columns = int(values[:, 1].max()) + 1, values.shape[1]
    dimension = (columns - 2) // 2
    frames = values.reshape(-1, nodes, columns)
    positions, velocities = np.zeros((2, len(frames), nodes, 3))
    positions[:, :, :dimension] = frames[:, :, 2 : 2 + dimension]
    velocities[:, :, :dimension] = frames[:, :, 2 + dimension :]
    return frames[:, 0, 0], positions, velocities


def assert_close(found, wanted, tolerance):
    """Relative to each number, or to the smallest that has all its bits."""
    wanted = np.asarray(wanted)
    assert found.shape == wanted.shape, (found.shape, wanted.shape)
    worst = np.abs(found - wanted) - tolerance * np.maximum(np.abs(wanted), SMALLEST)
    assert (worst <= 0).all(), f"off by {worst.max()}"


def mixed_cells(numbers):
    """The cells of an XDMF topology of mixed kinds, in order."""
    cells, left = [], iter(numbers.tolist())
    for kind in left:
        assert kind in (1, 2, 4), kind
        cells.append(tuple(islice(left, 3 if kind == 4 else next(left))))
    return cells


def xdmf_frames(path):
    """The time of each frame and {name: (array, dimensions as said)}, read through HDF5."""
    frames = []
    root = ElementTree.parse(path).getroot()
    assert root.tag == "Xdmf" and root.get("Version") == "3.0"
    collection = root.find("Domain/Grid")
    assert collection.get("CollectionType") == "Temporal"
    for grid in collection.findall("Grid"):
        items = {one.get("Name"): one.find("DataItem") for one in grid.findall("Attribute")}
        items["Topology"] = grid.find("Topology/DataItem")
        items["Points"] = grid.find("Geometry/DataItem")
        found = {}
        for name, item in items.items():
            file, place = item.text.split(":")
            with h5py.File(os.path.join(os.path.dirname(path), file)) as data:
                found[name] = data[place][...]
            said = tuple(int(word) for word in item.get("Dimensions").split())
            assert said == found[name].shape, (name, said, found[name].shape)
            assert int(item.get("Precision")) == found[name].dtype.itemsize
        frames.append((float(grid.find("Time").get("Value")), found))
    return frames
