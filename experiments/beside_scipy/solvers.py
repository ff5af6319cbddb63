"""Ways to solve M q'' = f(q) from Python, each as a user writes it. A way is a function of a problem
and a value of its knob that returns q and v at the end, and what was counted."""

import inspect

import numpy as np
import scipy.sparse as sp
from scipy.integrate import solve_ivp

import qddot

RTOLS = 10.0 ** -np.arange(2, 13)


def first_order(p, f):
    """y' of y = (q, v), as solve_ivp takes it."""
    mass, half = p.mass[:, None], p.q0.size

    def slope(t, y):
        q = y[:half].reshape(p.q0.shape)
        return np.concatenate((y[half:], (f(q) / mass).reshape(-1)))

    return slope


def jacobian(p):
    """[[0, I], [M^-1 K, 0]], as sparse as it is."""
    inverse = sp.diags(1 / np.repeat(p.mass, p.q0.shape[1]))
    eye = sp.identity(p.q0.size, format="csc")
    return lambda t, y: sp.bmat(
        [[None, eye], [inverse @ p.stiffness(y[: p.q0.size].reshape(p.q0.shape)), None]],
        format="csc",
    )


def scipy_ivp(p, f, method, rtol, scales):
    y0 = np.concatenate((p.q0.reshape(-1), p.v0.reshape(-1)))
    atol = rtol * np.repeat(scales, p.q0.size)
    more = {"jac": jacobian(p)} if method in ("Radau", "BDF") else {}
    s = solve_ivp(first_order(p, f), (0, p.until), y0, method, rtol=rtol, atol=atol, t_eval=[p.until],
                  **more)  # fmt: skip
    if not s.success:
        raise RuntimeError(s.message)
    q, v = np.split(s.y[:, -1], 2)
    return q.reshape(p.q0.shape), v.reshape(p.q0.shape), s.nfev


def numpy_verlet(p, f, h):
    steps = max(1, round(p.until / h))
    h, q, v, mass = p.until / steps, p.q0.copy(), p.v0.copy(), p.mass[:, None]
    a = f(q) / mass
    for _ in range(steps):
        v += h / 2 * a
        q += h * v
        a = f(q) / mass
        v += h / 2 * a
    return q, v, steps + 1


def own_system(p, force, method, knob):
    system = qddot.System(p.mass, force, dimension=p.dimension, check=False)
    s = qddot.solve(system, method, until=p.until, q0=p.q0, v0=p.v0, **knob).or_raise()
    return s.end.q, s.end.v, s.counts.force_evaluations


def own_system_with_k(p, force, method, knob):
    system = qddot.System(p.mass, force, None, p.stiffness, dimension=p.dimension, check=False)
    s = qddot.solve(system, method, until=p.until, q0=p.q0, v0=p.v0, **knob).or_raise()
    return s.end.q, s.end.v, s.counts.force_evaluations


def scene_by_method(scene, method, knob):
    s = qddot.solve(scene, method, until=scene.until, **knob).or_raise()
    return s.end.q[~scene.pinned], s.end.v[~scene.pinned], s.counts.force_evaluations


def scene_by_accuracy(scene, accuracy):
    s = qddot.solve(scene, accuracy=accuracy, until=scene.until).or_raise()
    return s.end.q[~scene.pinned], s.end.v[~scene.pinned], s.counts.force_evaluations


def lines_of(*functions):
    """How many lines of code they are, without blank ones and comments."""
    lines = [line.strip() for f in functions for line in inspect.getsource(f).splitlines()]
    return sum(bool(line) and not line.startswith(("#", '"""')) for line in lines)


LINES = {
    "solve_ivp": lines_of(first_order, scipy_ivp),
    "solve_ivp, with K": lines_of(first_order, jacobian, scipy_ivp),
    "NumPy Verlet": lines_of(numpy_verlet),
    "qddot, own f": lines_of(own_system),
    "qddot, own f and K": lines_of(own_system_with_k),
    "qddot, a scene": lines_of(scene_by_method),
    "qddot, an accuracy": lines_of(scene_by_accuracy),
}
