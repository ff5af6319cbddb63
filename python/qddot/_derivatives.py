"""Whether V, f and K are each other's derivatives."""

from __future__ import annotations

import numpy as np

from qddot import _qddot
from qddot._arrays import Floats

# How far differences of V and f may be from what they should be: errors of sign and of factors are
# far beyond it, rounding and curvature far below.
TOLERANCE = 1e-3


def check(model: _qddot.Model, q: Floats, length: float, has_own_stiffness: bool) -> None:
    """Holds V, f and K against each other at q, along one direction."""
    x = q.reshape(-1)
    f = model.force(x)
    if not np.all(np.isfinite(f)):
        # Of a callable, a number that it did not write is found so as well.
        i = int(np.flatnonzero(~np.isfinite(f))[0])
        raise ValueError(f"force: f[{i}] is {f[i]} at the start; is it written there, as by "
                         "np.copyto(f, ...)?")
    u = np.random.default_rng(1).standard_normal(x.size)
    d = 6e-6 * max(length, float(np.max(np.abs(x)))) / float(np.max(np.abs(u)))
    ahead, behind = model.force(x + d * u), model.force(x - d * u)
    if model.has_potential:
        fall = (model.potential(x - d * u) - model.potential(x + d * u)) / (2 * d)
        work = float((ahead + behind) @ u) / 2
        size = float((np.abs(f) + np.abs(ahead - behind)) @ np.abs(u))
        size += 1e-9 * abs(model.potential(x)) / d  # which is rounding
        if abs(fall - work) > TOLERANCE * size:
            raise ValueError(f"potential: it falls by {fall:.6g} J/m where the force does "
                             f"{work:.6g} J/m; f is -dV/dq (check=False takes it as it is)")
    if has_own_stiffness:
        k = _times(model, x, u)
        change = (ahead - behind) / (2 * d)
        size = float(np.max(np.abs(change))) + 1e-9 * float(np.max(np.abs(f))) / d
        if np.max(np.abs(k - change)) > TOLERANCE * size:
            sign = " with the other sign" if np.max(np.abs(k + change)) < TOLERANCE * size else ""
            raise ValueError(f"stiffness: it is not df/dq, as differences of the force say"
                             f"{'; it is that' + sign if sign else ''} (check=False takes it as "
                             "it is)")


def _times(model: _qddot.Model, x: Floats, u: Floats) -> Floats:
    data, rows, first = model.stiffness(x)
    columns = np.repeat(np.arange(x.size), np.diff(first))
    product = np.zeros_like(x)
    np.add.at(product, rows, data * u[columns])
    below = rows != columns
    np.add.at(product, columns[below], data[below] * u[rows[below]])
    return product
