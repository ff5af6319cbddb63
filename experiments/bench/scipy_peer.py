"""Runs one scene with one method of SciPy's solve_ivp, for bench, and prints how it went as JSON.

Call: scipy_peer.py PROBLEM.json METHOD RTOL LIMIT [LIBRARY SCENE.toml]. PROBLEM holds the free
nodes and their springs (see scipy_peer.cpp); LIMIT is the seconds a run may take. f is LIBRARY's
for the scene file, if given; else it is computed by NumPy with a sparse incidence matrix.
"""

import ctypes
import json
import statistics
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp
from scipy.sparse import csc_matrix, csr_matrix

REPEATS = 5
ENOUGH = 1.0  # seconds that repeats may take together


class Problem:
    """The equation of motion y' = (v, M^-1 f(q)) of masses and springs, and its Jacobian."""

    def __init__(self, data):
        self.dimension = data["dimension"]
        self.mass = np.array(data["mass"])
        self.nodes = len(self.mass)
        gravity = np.array(data["gravity"])[: self.dimension]
        load = np.array(data["load"]).reshape(self.nodes, self.dimension)
        self.stiffness = np.array(data["stiffness"])
        self.rest_length = np.array(data["rest_length"])
        self.quartic = np.array(data["quartic"])
        self.points = np.array(data["points"]).reshape(-1, self.dimension)
        self.from_node = np.array(data["from"], dtype=int)
        self.to_node = np.array(data["to"], dtype=int)
        # Fixed points stand behind the free nodes; (B x)_s = x_to - x_from.
        count = len(self.stiffness)
        signs, springs = np.repeat([-1.0, 1.0], count), np.tile(np.arange(count), 2)
        ends = np.concatenate([self.from_node, self.to_node])
        shape = (count, self.nodes + len(self.points))
        incidence = csr_matrix((signs, (springs, ends)), shape=shape)
        self.difference = incidence[:, : self.nodes].tocsr()
        self.offset = incidence[:, self.nodes :] @ self.points
        self.gather = (-self.difference.T).tocsr()
        self.per_mass = (1 / self.mass)[:, None]
        self.free_fall = gravity + load * self.per_mass

    def acceleration(self, q):
        """M^-1 f(q)."""
        d = self.difference @ q.reshape(-1, self.dimension) + self.offset
        l = np.sqrt(np.einsum("ij,ij->i", d, d))
        s = l - self.rest_length
        tension = s * (self.stiffness + self.quartic * s * s)
        pull = d * (tension / np.where(l > 0, l, 1))[:, None]
        # The force on a spring's first end is its pull: minus what the incidence matrix says.
        return ((self.gather @ pull) * self.per_mass + self.free_fall).ravel()

    def jacobian(self, q):
        """[[0, I], [M^-1 K, 0]] as compressed columns, its pattern with duplicates summed."""
        dim, n = self.dimension, self.nodes * self.dimension
        d = self.difference @ q.reshape(-1, dim) + self.offset
        l = np.sqrt(np.einsum("ij,ij->i", d, d))
        s = l - self.rest_length
        along = self.stiffness + 3 * self.quartic * s * s
        safe = np.where(l > 0, l, 1)
        across = np.where(l > 0, s * (self.stiffness + self.quartic * s * s) / safe, along)
        normal = d / safe[:, None]
        blocks = (along - across)[:, None, None] * normal[:, :, None] * normal[:, None, :]
        blocks += across[:, None, None] * np.eye(dim)
        rows, columns, values = [], [], []
        axis_i, axis_j = np.meshgrid(np.arange(dim), np.arange(dim), indexing="ij")
        ends = (self.from_node, self.to_node)
        for a in ends:
            for b in ends:
                free = (a < self.nodes) & (b < self.nodes)
                sign = -1.0 if a is b else 1.0
                value = sign * blocks[free] / self.mass[a[free]][:, None, None]
                rows.append((n + dim * a[free][:, None, None] + axis_i).ravel())
                columns.append((dim * b[free][:, None, None] + axis_j).ravel())
                values.append(value.ravel())
        rows.append(np.arange(n))
        columns.append(n + np.arange(n))
        values.append(np.ones(n))
        entries = (np.concatenate(rows), np.concatenate(columns))
        return csc_matrix((np.concatenate(values), entries), shape=(2 * n, 2 * n))


def acceleration_of(library, scene):
    """M^-1 f(q) of the compiled library."""
    code = ctypes.CDLL(library)
    code.qddot_forces.restype = ctypes.c_void_p
    code.qddot_forces.argtypes = [ctypes.c_char_p]
    code.qddot_acceleration.argtypes = [ctypes.c_void_p] * 3
    code.qddot_acceleration.restype = None
    forces = code.qddot_forces(scene.encode())
    if not forces:
        raise RuntimeError("the library does not take the scene")

    def acceleration(q):
        q = np.ascontiguousarray(q)
        a = np.empty_like(q)
        code.qddot_acceleration(forces, q.ctypes.data, a.ctypes.data)
        return a

    return acceleration


def solved(problem, acceleration, data, method, rtol, limit):
    """One run: the solution; raises TimeoutError after `limit` seconds."""
    q0, v0 = np.array(data["q"]), np.array(data["v"])
    n = len(q0)
    deadline = time.perf_counter() + limit

    def rate(_, y):
        if time.perf_counter() > deadline:
            raise TimeoutError
        return np.concatenate([y[n:], acceleration(y[:n])])

    options = {"jac": lambda _, y: problem.jacobian(y[:n])} if method != "DOP853" else {}
    atol = rtol * np.concatenate([np.full(n, data["length"]), np.full(n, data["speed"])])
    return solve_ivp(
        rate,
        (0.0, data["until"]),
        np.concatenate([q0, v0]),
        method=method,
        rtol=rtol,
        atol=atol,
        t_eval=[data["until"]],
        **options,
    )


def report(**words):
    """Prints the answer."""
    print(json.dumps(words))


def main(path, method, rtol, limit, library="", scene=""):
    """Runs until there are enough times, or they are long enough."""
    with open(path, encoding="utf-8") as file:
        data = json.load(file)
    problem = Problem(data)
    acceleration = acceleration_of(library, scene) if library else problem.acceleration
    times = []
    try:
        while len(times) < REPEATS and sum(times) < ENOUGH:
            start = time.process_time()
            solution = solved(problem, acceleration, data, method, float(rtol), float(limit))
            seconds = time.process_time() - start
            if solution.status != 0:
                return report(outcome="solver_failed")
            times.append(seconds)
    except TimeoutError:
        if not times:
            return report(outcome="over_budget", seconds=time.process_time() - start)
    y = solution.y[:, -1]
    n = len(y) // 2
    if not np.all(np.isfinite(y)):
        return report(outcome="not_finite")
    return report(
        outcome="reached_end",
        seconds=statistics.median(times),
        timed=len(times),
        force_evaluations=int(solution.nfev),
        q=list(y[:n]),
        v=list(y[n:]),
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
