"""The unknowns of a scene that remain after its reductions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Explanation:
    """The unknowns of a scene that remain, the reductions, and their reasons.

    `left_out` has pairs (reduction, sentence). `omega_max` [rad/s] is the largest natural frequency
    at the start, at most `omega_bound`. `largest_stable_step` = 2/omega_max [s] is that of Verlet's
    method. `unstable` is the number of directions in which the energy falls at the start; the
    motion along the fastest one grows as exp(growth t). print() shows all of that in sentences.
    """

    text: str
    drawn_unknowns: int
    unknowns: int
    left_out: tuple[tuple[str, str], ...]
    stiffness_is_constant: bool
    omega_max: float
    omega_bound: float
    unstable: int
    flat: int
    growth: float

    @property
    def largest_stable_step(self) -> float:
        return 2 / self.omega_max if self.omega_max > 0 else np.inf

    def __str__(self) -> str:
        return self.text.rstrip()
