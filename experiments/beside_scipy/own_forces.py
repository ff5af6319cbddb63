"""Two force laws as somebody writes them in NumPy: a planet, and a cloth of springs."""

import numpy as np
import scipy.sparse as sp


class Planet:
    """A planet around the sun, GM = 1: n = 2. Kepler's problem of eccentricity 0.6, 20 times around."""

    name, until, dimension = "planet", 20 * 2 * np.pi, 2
    mass = np.ones(1)
    q0 = np.array([[0.4, 0.0]])
    v0 = np.array([[0.0, 2.0]])

    def force(self, q):
        return -q / np.linalg.norm(q) ** 3

    def potential(self, q):
        return -1 / np.linalg.norm(q)

    def stiffness(self, q):
        r, x = np.linalg.norm(q), q.reshape(-1)
        return sp.csr_matrix(3 * np.outer(x, x) / r**5 - np.eye(2) / r**3)


class Cloth:
    """A scene's springs, forces by NumPy over all nodes that are not pinned: n = 3 x free nodes."""

    dimension = 3

    def __init__(self, scene, name):
        self.name, self.until = name, scene.until
        self.free = ~scene.pinned
        self.x0, self.g = scene.positions.copy(), scene.gravity
        self.i, self.j = scene.springs.T
        self.k, self.l0 = scene.stiffness[:, None], scene.rest_length[:, None]
        self.mass = scene.mass[self.free]
        self.q0, self.v0 = self.x0[self.free], scene.velocities[self.free]
        springs, nodes = np.arange(len(self.i)), len(self.x0)
        ones = np.ones(len(self.i))
        # (springs, free nodes): from the ends' positions to the springs' vectors, and back.
        across = sp.csr_matrix((ones, (springs, self.j)), (len(ones), nodes))
        across -= sp.csr_matrix((ones, (springs, self.i)), (len(ones), nodes))
        self.across = across[:, self.free]
        self.back = self.across.T.tocsr()
        self.fixed = across @ np.where(self.free[:, None], 0, self.x0)
        self.weight = self.mass[:, None] * self.g

    def springs(self, q):
        d = self.across @ q + self.fixed
        return d, np.sqrt((d * d).sum(axis=1, keepdims=True))

    def force(self, q):
        d, length = self.springs(q)
        return self.weight - self.back @ (self.k * (1 - self.l0 / length) * d)

    def potential(self, q):
        _, length = self.springs(q)
        return float((self.k * (length - self.l0) ** 2).sum() / 2 - (self.weight * q).sum())

    def stiffness(self, q):
        d, length = self.springs(q)
        n, ratio = d / length, self.l0 / length
        blocks = self.k[..., None] * (
            ratio[..., None] * n[:, :, None] * n[:, None, :] + (1 - ratio)[..., None] * np.eye(3)
        )
        count = len(d)
        middle = sp.bsr_matrix((blocks, np.arange(count), np.arange(count + 1)))
        gradient = sp.kron(self.across, np.eye(3), format="csr")
        return -(gradient.T @ middle @ gradient).tocsr()


NUMBA_PLANET = """
@cfunc(types.void(types.CPointer(types.float64), types.CPointer(types.float64), types.int64))
def force(q, f, n):
    r = (q[0] * q[0] + q[1] * q[1]) ** 0.5
    f[0] = -q[0] / r**3
    f[1] = -q[1] / r**3
"""


def numba_planet():
    """The planet's force as a C function; None without Numba."""
    try:
        from numba import cfunc, types
    except ImportError:
        return None
    names = {"cfunc": cfunc, "types": types}
    exec(NUMBA_PLANET, names)
    return names["force"]


def numba_cloth(cloth):
    """The cloth's force as a C function, in loops over the springs; None without Numba."""
    try:
        from numba import carray, cfunc, types
    except ImportError:
        return None
    row = np.full(len(cloth.free), -1)
    row[cloth.free] = np.arange(len(cloth.mass))
    a, b = row[cloth.i], row[cloth.j]
    k, l0, weight = cloth.k[:, 0].copy(), cloth.l0[:, 0].copy(), cloth.weight
    at_i, at_j = cloth.x0[cloth.i].copy(), cloth.x0[cloth.j].copy()
    nodes, springs = len(cloth.mass), len(k)

    @cfunc(types.void(types.CPointer(types.float64), types.CPointer(types.float64), types.int64))
    def force(q, f, n):
        x, out = carray(q, (nodes, 3)), carray(f, (nodes, 3))
        for i in range(nodes):
            for c in range(3):
                out[i, c] = weight[i, c]
        for s in range(springs):
            i, j = a[s], b[s]
            if j >= 0:
                x1, y1, z1 = x[j, 0], x[j, 1], x[j, 2]
            else:
                x1, y1, z1 = at_j[s, 0], at_j[s, 1], at_j[s, 2]
            if i >= 0:
                x0, y0, z0 = x[i, 0], x[i, 1], x[i, 2]
            else:
                x0, y0, z0 = at_i[s, 0], at_i[s, 1], at_i[s, 2]
            dx, dy, dz = x1 - x0, y1 - y0, z1 - z0
            pull = k[s] * (1 - l0[s] / (dx * dx + dy * dy + dz * dz) ** 0.5)
            if i >= 0:
                out[i, 0] += pull * dx
                out[i, 1] += pull * dy
                out[i, 2] += pull * dz
            if j >= 0:
                out[j, 0] -= pull * dx
                out[j, 1] -= pull * dy
                out[j, 2] -= pull * dz

    return force
