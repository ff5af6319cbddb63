"""Problems that the tests of the module share."""

import ctypes
import os
import shutil
import subprocess
import tempfile
import unittest

import numpy as np

try:
    import scipy.sparse
except ImportError:
    scipy = None

import qddot
from programs import table, write


needs_scipy = unittest.skipUnless(scipy, "it needs SciPy")


def read_table(path):
    """The columns of a CSV file; where one is empty it is nan."""
    rows = table(path)
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    return {n: np.array([np.nan if x is None else x for x in c]) for n, c in columns.items()}


def random_scene(seed, dimension=3):
    """A network of springs without a symmetry, that hangs from one node and was pushed."""
    random = np.random.default_rng(seed)
    nodes = 8
    positions = np.arange(nodes)[:, None] * np.eye(dimension)[0] * 0.5
    positions = positions + 0.1 * random.standard_normal((nodes, dimension))
    springs = [(i, i + 1) for i in range(nodes - 1)] + [(i, i + 2) for i in range(nodes - 2)]
    return qddot.Scene(
        positions=positions, springs=springs, stiffness=random.uniform(100, 1000, len(springs)),
        mass=random.uniform(0.1, 0.3, nodes), pinned=[0], gravity=-9.81 * np.eye(dimension)[-1],
        velocities=random.standard_normal((nodes, dimension)),
        rest_length=random.uniform(0.4, 0.6, len(springs)), name=f"random {seed}",
    )  # fmt: skip


def duffing_force(q, f):
    """f of V = q^2/2 + q^4/4, for each unknown by itself."""
    np.copyto(f, -q - q * q * q)


def duffing_potential(q):
    return float((q**2 / 2 + q**4 / 4).sum())


def duffing_stiffness(q):
    return np.diag(-1 - 3 * q**2)


class Chain:
    """Springs between neighbours in the plane between two pins, by NumPy alone: an independent f, V
    and K."""

    def __init__(self, nodes, stiffness=100.0):
        self.nodes, self.k, self.rest = nodes, stiffness, 1.0

    def _bonds(self, q):
        x = np.concatenate(([[0.0, 0.0]], q, [[self.nodes + 1.0, 0.0]]))
        d = np.diff(x, axis=0)
        return d, np.linalg.norm(d, axis=1)

    def force(self, q, f):
        d, length = self._bonds(q)
        pull = (self.k * (length - self.rest) / length)[:, None] * d
        f[:] = pull[1:] - pull[:-1]

    def potential(self, q):
        return float((self.k * (self._bonds(q)[1] - self.rest) ** 2 / 2).sum())

    def blocks(self, q):
        d, length = self._bonds(q)
        n = d / length[:, None]
        across = self.k * (length - self.rest) / length
        along = n[:, :, None] * n[:, None, :]
        return self.k * along + across[:, None, None] * (np.eye(2) - along)

    def stiffness(self, q):
        k = np.zeros((2 * self.nodes, 2 * self.nodes))
        for bond, block in enumerate(self.blocks(q)):
            ends = [node for node in (bond - 1, bond) if 0 <= node < self.nodes]
            for i in ends:
                for j in ends:
                    k[2 * i : 2 * i + 2, 2 * j : 2 * j + 2] += block if i != j else -block
        return k

    def start(self):
        q = np.column_stack((np.arange(1, self.nodes + 1.0), np.zeros(self.nodes)))
        v = np.column_stack((0.1 * np.sin(np.arange(self.nodes)), np.cos(np.arange(self.nodes))))
        return q, v

    def scene(self):
        """The same as a scene."""
        q, v = self.start()
        return qddot.Scene(
            positions=np.concatenate(([[0.0, 0.0]], q, [[self.nodes + 1.0, 0.0]])),
            velocities=np.pad(v, ((1, 1), (0, 0))),
            springs=[(i, i + 1) for i in range(self.nodes + 1)], stiffness=self.k, mass=1.0,
            rest_length=self.rest, pinned=[0, self.nodes + 1],
        )  # fmt: skip

    def system(self, **changes):
        given = {"force": self.force, "potential": self.potential, "stiffness": self.stiffness}
        return qddot.System(np.ones(self.nodes), dimension=2, **{**given, **changes})


def compiled(source):
    """A C library of that source, loaded by ctypes; it stays as long as the process."""
    folder = tempfile.mkdtemp()
    path, made = write(f"{folder}/library.c", source), f"{folder}/library.so"
    if not shutil.which(os.environ.get("CC", "cc")):
        raise unittest.SkipTest("it needs a C compiler")
    words = [os.environ.get("CC", "cc"), "-O2", "-shared", "-fPIC", path, "-o", made]
    subprocess.run(words, check=True)
    return ctypes.CDLL(made)


DUFFING_C = """
#include <stdint.h>
void force(const double* q, double* f, int64_t n) {
  for (int64_t i = 0; i < n; ++i) f[i] = -q[i] - q[i] * q[i] * q[i];
}
double potential(const double* q, int64_t n) {
  double v = 0;
  for (int64_t i = 0; i < n; ++i) v += q[i] * q[i] / 2 + q[i] * q[i] * q[i] * q[i] / 4;
  return v;
}
"""
