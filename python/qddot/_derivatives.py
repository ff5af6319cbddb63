"""Checks that f and K are the derivatives of V and f."""

from __future__ import annotations

from typing import Iterator

import numpy as np

from qddot import _qddot
from qddot._arrays import Floats

# The allowed error of differences. Those of second order have errors of about 1e-10 for a smooth V;
# a wrong sign or factor gives far larger ones.
TOLERANCE = 1e-4
# The relative rounding error of sums.
ROUNDING = 1e-12
# Up to FEW unknowns each force is checked by itself; more are checked along DIRECTIONS directions.
FEW, DIRECTIONS = 100, 3
AS_IT_IS = "(check=False takes it as it is)"


def check(model: _qddot.Model, length: float, has_own_stiffness: bool) -> None:
    """Compares f, V and K with each other's differences beside the start, where no symmetry hides
    anything. `length` [m]: a small length there."""
    start = model.q
    f = model.force(start)
    if not np.all(np.isfinite(f)):
        # This also finds a number that a callable did not write.
        i = int(np.flatnonzero(~np.isfinite(f))[0])
        raise ValueError(
            f"force: f[{i}] is {f[i]} at the start; is it written there, as by "
            "np.copyto(f, ...)?"
        )
    random = np.random.default_rng(1)
    x = start + 1e-3 * length * random.uniform(-1, 1, start.size)
    if not np.all(np.isfinite(model.force(x))):
        x = start
    # Smaller differences would be rounding, far from the origin.
    d = max(6e-6 * length, 2e-11 * float(np.max(np.abs(x))))
    if model.has_potential:
        for u in _directions(x.size, random):
            _check_energy(model, x, u, d)
    if model.has_stiffness:
        _check_stiffness(model, x, random.uniform(-1, 1, x.size), d, has_own_stiffness)


def _directions(n: int, random: np.random.Generator) -> Iterator[Floats]:
    if n <= FEW:
        yield from np.eye(n)
        return
    for _ in range(DIRECTIONS):
        yield random.uniform(-1, 1, n)


def _check_energy(model: _qddot.Model, x: Floats, u: Floats, d: float) -> None:
    ahead, behind = model.force(x + d * u), model.force(x - d * u)
    fall = (model.potential(x - d * u) - model.potential(x + d * u)) / (2 * d)
    work = float((ahead + behind) @ u) / 2
    size = float((np.abs(ahead) + np.abs(ahead - behind)) @ np.abs(u))
    size += (abs(fall) + abs(work)) / 2
    rounding = ROUNDING * (abs(model.potential(x)) + d * float(np.max(np.abs(ahead)))) / d
    if not abs(fall - work) <= TOLERANCE * size + rounding:
        raise ValueError(
            f"potential: beside the start it falls by {fall:.6g} J/m where the force does "
            f"{work:.6g} J/m; f is -dV/dq {AS_IT_IS}"
        )


def _check_stiffness(
    model: _qddot.Model, x: Floats, u: Floats, d: float, has_own_stiffness: bool
) -> None:
    ahead, behind = model.force(x + d * u), model.force(x - d * u)
    change, k = (ahead - behind) / (2 * d), _times(model, x, u)
    size = TOLERANCE * float(np.max(np.abs(change)))
    size += ROUNDING * float(np.max(np.abs(ahead))) / d
    if np.max(np.abs(k - change)) <= size:
        return
    if not has_own_stiffness:
        raise ValueError(
            "pattern: the K that is made by it is not df/dq; it lacks entries, or `length` "
            f"is no small length of the motion {AS_IT_IS}"
        )
    sign = "; it is that with the other sign" if np.max(np.abs(k + change)) <= size else ""
    raise ValueError(
        "stiffness: beside the start it is not df/dq, as differences of the force say"
        f"{sign} {AS_IT_IS}"
    )


def _times(model: _qddot.Model, x: Floats, u: Floats) -> Floats:
    data, rows, first = model.stiffness(x)
    columns = np.repeat(np.arange(x.size), np.diff(first))
    product = np.zeros_like(x)
    np.add.at(product, rows, data * u[columns])
    below = rows != columns
    np.add.at(product, columns[below], data[below] * u[rows[below]])
    return product
