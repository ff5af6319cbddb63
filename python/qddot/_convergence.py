"""The observed order of convergence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from qddot._arrays import Floats, count, number
from qddot._reference import Reference, reference as make_reference
from qddot._scene import Scene
from qddot._solve import solve
from qddot._system import System


@dataclass(frozen=True, eq=False)
class Convergence:
    """Errors of a method at h, h/2, h/4, ... [s], and the order of each halving: log2 of the ratio
    of errors. An order is NaN if one of its two runs did not reach the end, or if an error is near
    the certified one."""

    method: str
    step_size: Floats
    error_position: Floats
    error_velocity: Floats
    order: Floats


def convergence(
    of: Scene | System,
    method: str,
    step_size: float,
    halvings: int = 6,
    *,
    until: float | None = None,
    q0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    reference: Reference | None = None,
) -> Convergence:
    """The observed order of convergence of a method of fixed steps, from `step_size` [s] on."""
    exact = reference or make_reference(of, until, q0=q0, v0=v0)
    exact.require(of, q0, v0)
    if until is not None and until != exact.until:
        raise ValueError(f"reference: it is that of {exact.until:g} s, and until is {until:g} s")
    steps = number(step_size, "step_size") / 2.0 ** np.arange(count(halvings, "halvings") + 1)
    q, v = np.full(len(steps), np.nan), np.full(len(steps), np.nan)
    for i, h in enumerate(steps):
        solution = solve(of, method, step_size=float(h), until=exact.until, q0=q0, v0=v0)
        if solution.success:
            errors = exact.errors(solution)
            q[i], v[i] = errors.position, errors.velocity
    # An error of twenty times the certified one is wrong by up to 5 %: 0.07 in the order.
    known = np.where(q > 20 * exact.certified.position, q, np.nan)
    order = np.full(len(steps), np.nan)
    order[1:] = np.log2(known[:-1] / known[1:])
    return Convergence(method, steps, q, v, order)
