"""How arrays come in and go out."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
A = TypeVar("A", bound="np.ndarray[Any, Any]")


def floats(value: ArrayLike, name: str, one: bool = False) -> Floats:
    """Numbers in C order; a scalar is an array of one where that may be."""
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: it is no array of numbers ({error})") from None
    return array.reshape(-1) if one and np.ndim(value) < 2 else array


def whole_numbers(value: ArrayLike, name: str) -> NDArray[np.int64]:
    """Whole numbers, which may be written as floats."""
    array = np.asarray(value)
    if array.size == 0:
        return np.zeros(array.shape, dtype=np.int64)
    if array.dtype.kind not in "iuf" or not np.all(array == np.floor(array)):
        raise ValueError(f"{name}: it has entries that are no whole numbers")
    return np.ascontiguousarray(array, dtype=np.int64)


def frozen(array: A) -> A:
    """The same array, read-only."""
    array.setflags(write=False)
    return array
