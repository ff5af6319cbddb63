"""Functions of time: how supports move, and how loads and gravity change."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from qddot._arrays import Floats, floats, number
from qddot._names import knows_its_arguments


class Curve:
    """A vector of time [s]: the displacement of a support [m], a load [N] or an acceleration
    [m/s^2]. It is the sum of what is given:

    polynomial: (terms, dimension), the coefficients of 1, t, t^2, ...
    harmonics: tuples (amplitude, angular frequency [rad/s]) or (amplitude, angular frequency, phase
    [rad]), each amplitude * sin(frequency * t + phase).
    times, values: a table, (times) and (times, dimension), by a cubic spline with two continuous
    derivatives or, if interpolation is "linear", by straight lines. It rests before and after.
    function, rate: functions of t that return the vector and its derivative.

    Raises ValueError, with one sentence, for wrong input.
    """

    @knows_its_arguments
    def __init__(
        self,
        *,
        polynomial: ArrayLike | None = None,
        harmonics: Sequence[Sequence[Any]] = (),
        times: ArrayLike | None = None,
        values: ArrayLike | None = None,
        interpolation: str = "spline",
        function: Callable[[float], ArrayLike] | None = None,
        rate: Callable[[float], ArrayLike] | None = None,
    ) -> None:
        if interpolation not in ("spline", "linear"):
            raise ValueError(f"interpolation: {interpolation!r}; allowed are spline and linear")
        if (times is None) != (values is None):
            raise ValueError("times and values: one is given without the other")
        if (function is None) != (rate is None):
            raise ValueError(
                "function and rate: one is given without the other; the rate decides the work that "
                "a support does"
            )
        self.polynomial = _vectors(() if polynomial is None else polynomial, "polynomial")
        self.harmonics = [_harmonic(given) for given in harmonics]
        self.times = None if times is None else floats(times, "times").reshape(-1)
        self.values = None if values is None else _vectors(values, "values")
        self.interpolation = interpolation
        self.function = function
        self.rate = rate
        if self.times is not None and self.values is not None:
            if len(self.times) < 2 or len(self.values) != len(self.times):
                raise ValueError(
                    f"values: {len(self.values)} for {len(self.times)} times; allowed are one for "
                    "each of two times or more"
                )
            if not np.all(np.diff(self.times) > 0):
                raise ValueError("times: allowed are times that ascend")

    def _record(self, dimension: int, name: str) -> dict[str, Any]:
        """The curve for the scene, in whose dimension all vectors must be."""
        sizes = {len(amplitude) for amplitude, _, _ in self.harmonics}
        sizes |= {x.shape[1] for x in (self.polynomial, self.values) if x is not None and len(x)}
        if sizes - {dimension}:
            raise ValueError(
                f"{name}: its vectors have {sorted(sizes)} components; allowed are {dimension}, "
                "those of the positions"
            )
        return dict(
            polynomial=self.polynomial,
            harmonics=self.harmonics,
            times=None if self.times is None else self.times.tolist(),
            values=self.values,
            interpolation=self.interpolation,
            function=self.function,
            rate=self.rate,
        )


def _vectors(value: ArrayLike, name: str) -> Floats:
    """Rows of vectors; numbers are vectors of one component."""
    array = floats(value, name)
    if array.ndim == 1:
        array = array.reshape(-1, 1)
    if array.ndim != 2:
        raise ValueError(f"{name}: its shape is {array.shape}; allowed is (count, dimension)")
    return array


def _harmonic(given: Sequence[Any]) -> tuple[Floats, float, float]:
    if len(given) not in (2, 3):
        raise ValueError(
            f"harmonics: {given!r}; allowed are (amplitude, angular frequency) and (amplitude, "
            "angular frequency, phase)"
        )
    amplitude = floats(given[0], "amplitude", one=True).reshape(-1)
    phase = number(given[2], "phase") if len(given) == 3 else 0.0
    return amplitude, number(given[1], "frequency"), phase


# Curves by the numbers of nodes, or one for all.
Curves = Mapping[int, Curve]


@dataclass
class HeldCurves:
    """The curves of a scene, each once, and the number of that of each node, or -1."""

    records: list[dict[str, Any]]
    of_nodes: NDArray[np.int64]
    of_gravity: int


def held(
    motion: Curves | None,
    load_in_time: Curves | None,
    gravity_in_time: Curve | None,
    is_pinned: NDArray[np.bool_],
    dimension: int,
) -> HeldCurves:
    """The curves of these arguments of Scene()."""
    result = HeldCurves([], np.full(len(is_pinned), -1, dtype=np.int64), -1)
    numbers: dict[int, int] = {}

    def number_of(curve: Curve, name: str) -> int:
        if not isinstance(curve, Curve):
            raise ValueError(f"{name}: {curve!r} is no qddot.Curve")
        if id(curve) not in numbers:
            numbers[id(curve)] = len(result.records)
            result.records.append(curve._record(dimension, name))
        return numbers[id(curve)]

    for name, curves, pinned in (("motion", motion, True), ("load_in_time", load_in_time, False)):
        for node, curve in (curves or {}).items():
            where = f"{name}[{node}]"
            if not 0 <= node < len(is_pinned):
                raise ValueError(
                    f"{where}: node {node} is none of the {len(is_pinned)} nodes, which count from "
                    "0"
                )
            if is_pinned[node] != pinned:
                allowed = "pinned ones" if pinned else "nodes that are not pinned"
                raise ValueError(f"{where}: allowed are {allowed}")
            result.of_nodes[node] = number_of(curve, where)
    if gravity_in_time is not None:
        result.of_gravity = number_of(gravity_in_time, "gravity_in_time")
    return result


def curve_of(record: dict[str, Any]) -> Curve:
    """The curve of such a record."""
    given = dict(record)
    if not len(given["polynomial"]):
        given["polynomial"] = None
    return Curve(**given)
