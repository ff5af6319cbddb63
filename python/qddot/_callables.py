"""Callables and C functions that a System is made of."""

from __future__ import annotations

import ctypes
import inspect
from typing import Any


def require_arguments(function: Any, name: str, count: int) -> None:
    """Raises ValueError for a callable that takes other arguments than q, or q and f."""
    if not callable(function):
        raise ValueError(
            f"{name}: it is neither a callable nor a C function (a Numba cfunc, a ctypes "
            "or cffi pointer)"
        )
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return
    try:
        signature.bind(*range(count))
    except TypeError:
        takes = "(q, f)" if count == 2 else "(q)"
        raise ValueError(
            f"{name}: it takes {signature}; it is called as {name}{takes}. Forces that depend on the "
            "velocity or on time are not modelled, and no method would look at them"
        ) from None


def callable_or_address(function: Any, name: str, count: int) -> Any:
    """The callable, or the address of a C function."""
    if function is None:
        return None
    c_type = (
        "void (const double* q, double* f, int64_t n)"
        if count == 2
        else "double (const double* q, int64_t n)"
    )
    if hasattr(function, "address") and hasattr(function, "native_name"):  # Numba's
        expected = (
            "(float64*, float64*, int64) -> none" if count == 2 else "(float64*, int64) -> float64"
        )
        signature = str(getattr(function, "_sig", expected))
        if signature != expected:
            raise ValueError(f"{name}: the cfunc is {signature}; allowed is {expected}")
        return int(function.address)
    if isinstance(function, ctypes._CFuncPtr):  # type: ignore[attr-defined]
        given = function.argtypes
        if given is not None and len(given) != count + 1:
            raise ValueError(f"{name}: the C function takes {len(given)} arguments; it is {c_type}")
        address = ctypes.cast(function, ctypes.c_void_p).value
        if not address:
            raise ValueError(f"{name}: the C function is a null pointer")
        return address
    if type(function).__module__ == "_cffi_backend":
        import _cffi_backend  # type: ignore[import]

        kind = _cffi_backend.FFI().typeof(function)
        if kind.kind != "function" or len(kind.args) != count + 1:
            raise ValueError(f"{name}: it is {kind.cname}; allowed is {c_type}")
        address = int(_cffi_backend.FFI().cast("intptr_t", function))
        if not address:
            raise ValueError(f"{name}: the C function is a null pointer")
        return address
    require_arguments(function, name, count)
    return function
