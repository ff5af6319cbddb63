"""Conversion of arrays on their way in and out."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
A = TypeVar("A", bound="np.ndarray[Any, Any]")


def floats(value: ArrayLike, name: str, one: bool = False) -> Floats:
    """Numbers in C order; a scalar becomes an array of one if that is allowed."""
    require_unmasked(value, name)
    try:
        given = np.asarray(value)
        if given.dtype.kind not in "iufO":
            raise TypeError(f"its entries are {given.dtype}")
        array = np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: it is no array of real numbers ({error})") from None
    return array.reshape(-1) if one and given.ndim < 2 else array


def whole_numbers(value: ArrayLike, name: str) -> NDArray[np.int64]:
    """Whole numbers, which may be written as floats."""
    array = np.asarray(value)
    if array.size == 0:
        return np.zeros(array.shape, dtype=np.int64)
    if array.dtype.kind not in "iuf" or not np.all(array == np.floor(array)):
        raise ValueError(f"{name}: it has entries that are no whole numbers")
    require_unmasked(value, name)
    return np.ascontiguousarray(array, dtype=np.int64)


def flags(value: ArrayLike, name: str) -> Floats:
    """True and False as 1 and 0; a scalar becomes an array of one."""
    given = np.asarray(value)
    if given.dtype != bool:
        raise ValueError(f"{name}: its entries are {given.dtype}; allowed are True and False")
    require_unmasked(value, name)
    return np.ascontiguousarray(given, dtype=np.float64).reshape(-1)


def require_unmasked(value: ArrayLike, name: str) -> None:
    """Raises ValueError for a masked array, whose mask would be lost."""
    if np.any(getattr(value, "mask", False)):
        raise ValueError(f"{name}: some of its entries are masked; allowed are numbers alone")


def number(value: Any, name: str) -> float:
    """One real number."""
    try:
        if np.ndim(value) == 0 and not isinstance(value, (str, bytes, bool, complex)):
            return float(value)
    except (TypeError, ValueError):
        pass
    raise ValueError(f"{name}: {value!r} is no number")


def count(value: Any, name: str, least: int = 1, most: int | None = None) -> int:
    """One whole number within bounds."""
    x = number(value, name)
    if not np.isfinite(x) or x != int(x):
        raise ValueError(f"{name}: {value!r} is no whole number")
    if x < least or (most is not None and x > most):
        bounds = f"{least} or more" if most is None else f"from {least} to {most}"
        raise ValueError(f"{name} {value} is not allowed; it is {bounds}")
    return int(x)


def ascending_times(value: ArrayLike, name: str, end: float) -> list[float]:
    """Times [s] that ascend from 0 to the end."""
    times = floats(value, name, one=True).reshape(-1).copy()
    # The last number of np.arange may be some roundings beyond the end.
    times[(times > end) & (times <= end * (1 + 1e-14))] = end
    if times.size and not (np.all(np.diff(times) >= 0) and times[0] >= 0 and times[-1] <= end):
        raise ValueError(
            f"{name}: its times must ascend from 0 to until = {end!r} s, and they go from "
            f"{float(times[0])!r} to {float(times[-1])!r}"
        )
    return [float(t) for t in times]


def frozen(array: A) -> A:
    """The same array, read-only."""
    array.setflags(write=False)
    return array
