"""An own M q'' = f(q): by callables, or by C functions at full speed."""

from __future__ import annotations

import ctypes
import inspect
from typing import TYPE_CHECKING, Any, Callable

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import Floats, floats

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Pattern = tuple[NDArray[np.int64], NDArray[np.int64]]

# How far differences of V and f may be from what they should be: errors of sign and of factors are
# far beyond it, rounding and curvature far below.
TOLERANCE = 1e-3


class System:
    """Forces of one's own: M q'' = f(q), with f = -dV/dq.

    mass [kg]: (n), or (nodes) and (nodes, dimension) where a dimension 1, 2 or 3 is given. q and f
    have the shape (n), or (nodes, dimension).

    force(q, f) writes f [N]. potential(q) returns V [J]. stiffness(q) returns
    K = df/dq [N/m], n x n and symmetric, as a scipy.sparse matrix or an array; mind the sign, many
    codes have -K. q and f are views of the solver's memory: q cannot be written, and neither may be
    kept beyond the call. force and potential may also be C functions (a Numba cfunc, a ctypes or
    cffi pointer), which cost no more than those of qddot:
        void force(const double* q, double* f, int64_t n);
        double potential(const double* q, int64_t n);

    What is missing decides what is offered. By force alone: explicit methods. With potential:
    energies, and a line search in implicit ones. With stiffness, or a pattern of K (its nonzeros: a
    sparse or dense matrix of n x n unknowns or of nodes x nodes, pairs (m, 2) of unknowns, or
    "dense") by which K is made of differences of f: implicit methods, SUNDIALS', references, answers
    to an accuracy.

    `length` [m]: a small length of the motion, for these differences. With `check` the first start is
    looked at: f must be finite there, -dV/dq and K what differences of V and f say. Forces that
    depend on the velocity or on time are not modelled: a force that takes them is refused.
    """

    mass: Floats

    def __init__(
        self,
        mass: ArrayLike,
        force: Any,
        potential: Any = None,
        stiffness: Callable[[Floats], Any] | None = None,
        pattern: Any = None,
        *,
        dimension: int | None = None,
        length: float = 1.0,
        check: bool = True,
    ) -> None:
        if dimension not in (None, 1, 2, 3):
            raise ValueError(f"dimension {dimension} is not allowed; it is 1, 2, 3 or None")
        m = floats(mass, "mass", one=True)
        if dimension is not None and m.ndim == 1:
            m = np.repeat(m[:, None], dimension, axis=1)
        if m.ndim != (1 if dimension is None else 2) or m.shape[1:] not in ((), (dimension,)):
            raise ValueError(f"mass: its shape is {m.shape}; allowed are (n), or (nodes) and (nodes, "
                             "dimension) with a dimension")
        if not np.all(np.isfinite(m)) or np.any(m < 0) or m.size == 0:
            raise ValueError("mass: allowed are finite numbers of at least 0 in kg, one or more")
        if not length > 0:
            raise ValueError(f"length {length} is not allowed; it is a length in m above 0")
        self.mass = m
        self.dimension = dimension
        self._length = float(length)
        self._force = _callable_or_address(force, "force", 2)
        self._potential = _callable_or_address(potential, "potential", 1)
        self._stiffness = stiffness
        if stiffness is not None:
            _require_arguments(stiffness, "stiffness", 1)
        self._kept_alive = (force, potential)
        self._pattern: Pattern | None = None if pattern is None else self._pairs(pattern)
        self._must_check = check

    @property
    def has_potential(self) -> bool:
        """Whether it computes V."""
        return self._potential is not None

    @property
    def has_stiffness(self) -> bool:
        """Whether K is computed, or made of differences."""
        return self._stiffness is not None or self._pattern is not None

    def _pairs(self, pattern: Any) -> Pattern:
        n = self.mass.size
        rows, columns = self._entries(pattern)
        beyond = (rows < 0) | (rows >= n) | (columns < 0) | (columns >= n)
        if np.any(beyond):
            i = int(np.flatnonzero(beyond)[0])
            raise ValueError(f"pattern: entry ({rows[i]}, {columns[i]}) is not among the {n} unknowns")
        return rows.astype(np.int64), columns.astype(np.int64)

    def _entries(self, pattern: Any) -> Pattern:
        n = self.mass.size
        if isinstance(pattern, str):
            if pattern != "dense":
                raise ValueError(f"pattern {pattern!r} is not allowed; the only word is 'dense'")
            return np.tril_indices(n)
        if hasattr(pattern, "tocoo"):
            coo = pattern.tocoo()
            shape, rows, columns = coo.shape, coo.row, coo.col
        else:
            array = np.asarray(pattern)
            if array.ndim == 2 and array.shape[1] == 2 and array.shape != (2, 2):
                shape, (rows, columns) = (n, n), array.T
            elif array.shape == (2, 2) and n != 2 and len(self.mass) != 2:
                shape, (rows, columns) = (n, n), array.T
            else:
                shape, (rows, columns) = array.shape, np.nonzero(array)
        if shape == (n, n):
            return rows, columns
        nodes = len(self.mass)
        if shape == (nodes, nodes) and self.dimension is not None:
            d = self.dimension
            a, b = (x.reshape(-1) for x in np.indices((d, d)))
            return (rows[:, None] * d + a).reshape(-1), (columns[:, None] * d + b).reshape(-1)
        raise ValueError(
            f"pattern: its shape is {shape}; allowed are ({n}, {n}), pairs (m, 2) of unknowns and, "
            f"with a dimension, (nodes, nodes) = ({nodes}, {nodes})"
        )

    def _columns(self, q: Floats) -> Any:
        """K as the extension takes it: dense, or (data, indices, indptr) of its sorted columns."""
        assert self._stiffness is not None
        k = self._stiffness(q)
        if not hasattr(k, "tocsc"):
            return np.asarray(k, dtype=np.float64)
        # Rows are columns, as K is symmetric. The caller's own matrix stays as it is.
        if k.format not in ("csr", "csc"):
            k = k.tocsc()
        if not k.has_canonical_format:
            k = k.copy()
            k.sum_duplicates()
        if k.shape != (q.size, q.size):
            raise ValueError(f"stiffness: it returned {k.shape[0]} x {k.shape[1]} numbers; allowed "
                             f"is {q.size} x {q.size}")
        return k.data, k.indices, k.indptr

    def _model(self, q0: ArrayLike | None, v0: ArrayLike | None) -> _qddot.Model:
        """The system from that start."""
        q = self._numbers(q0, "q0")
        v = np.zeros_like(q) if v0 is None else self._numbers(v0, "v0")
        if self._stiffness is not None and self._pattern is None:
            self._pattern = self._pattern_near(q)
        model = self._made(q, v)
        if self._must_check:
            self._check(model, q)
            self._must_check = False
        return model

    def _made(self, q: Floats, v: Floats) -> _qddot.Model:
        return _qddot.own_model(
            self.mass.reshape(-1),
            list(self.mass.shape),
            self._force,
            self._potential,
            None if self._stiffness is None else self._columns,
            self._pattern,
            self._length,
            q.reshape(-1),
            v.reshape(-1),
            self.dimension or 1,
        )

    def _numbers(self, value: ArrayLike | None, name: str) -> Floats:
        if value is None:
            raise ValueError(f"{name} is missing; a System starts there, {self.mass.shape} numbers")
        array = floats(value, name)
        if array.shape != self.mass.shape:
            raise ValueError(f"{name}: its shape is {array.shape}; allowed is {self.mass.shape}, that "
                             "of the masses")
        return array

    def _pattern_near(self, q: Floats) -> Pattern:
        """The entries of K at q and beside it, where none is zero by symmetry."""
        beside = np.random.default_rng(0).uniform(0.5, 1, q.shape) * 1e-3 * self._length
        rows, columns = [], []
        for place in (q.copy(), q + beside):
            place.setflags(write=False)
            k = self._columns(place)
            if not isinstance(k, tuple):
                return self._pairs("dense")
            rows.append(np.asarray(k[1], dtype=np.int64))
            columns.append(np.repeat(np.arange(q.size, dtype=np.int64), np.diff(k[2])))
        return np.concatenate(rows), np.concatenate(columns)

    def _check(self, model: _qddot.Model, q: Floats) -> None:
        """Holds V, f and K against each other at q, along one direction."""
        x = q.reshape(-1)
        f = model.force(x)
        if not np.all(np.isfinite(f)):
            # Of a callable, a number that it did not write is found so as well.
            i = int(np.flatnonzero(~np.isfinite(f))[0])
            raise ValueError(f"force: f[{i}] is {f[i]} at the start; is it written there, as by "
                             "np.copyto(f, ...)?")
        u = np.random.default_rng(1).standard_normal(x.size)
        d = 6e-6 * max(self._length, float(np.max(np.abs(x)))) / float(np.max(np.abs(u)))
        ahead, behind = model.force(x + d * u), model.force(x - d * u)
        if self.has_potential:
            fall = (model.potential(x - d * u) - model.potential(x + d * u)) / (2 * d)
            work = float((ahead + behind) @ u) / 2
            size = float((np.abs(f) + np.abs(ahead - behind)) @ np.abs(u))
            size += 1e-9 * abs(model.potential(x)) / d  # which is rounding
            if abs(fall - work) > TOLERANCE * size:
                raise ValueError(f"potential: it falls by {fall:.6g} J/m where the force does "
                                 f"{work:.6g} J/m; f is -dV/dq (check=False takes it as it is)")
        if self._stiffness is not None:
            k = self._stiffness_times(model, x, u)
            change = (ahead - behind) / (2 * d)
            size = float(np.max(np.abs(change))) + 1e-9 * float(np.max(np.abs(f))) / d
            if np.max(np.abs(k - change)) > TOLERANCE * size:
                sign = " with the other sign" if np.max(np.abs(k + change)) < TOLERANCE * size else ""
                raise ValueError(f"stiffness: it is not df/dq, as differences of the force say"
                                 f"{'; it is that' + sign if sign else ''} (check=False takes it as "
                                 "it is)")

    def _stiffness_times(self, model: _qddot.Model, x: Floats, u: Floats) -> Floats:
        data, rows, first = model.stiffness(x)
        columns = np.repeat(np.arange(x.size), np.diff(first))
        product = np.zeros_like(x)
        np.add.at(product, rows, data * u[columns])
        below = rows != columns
        np.add.at(product, columns[below], data[below] * u[rows[below]])
        return product


def _require_arguments(function: Any, name: str, count: int) -> None:
    """A sentence for a callable that takes something else than q, and f."""
    if not callable(function):
        raise ValueError(f"{name}: it is neither a callable nor a C function (a Numba cfunc, a ctypes "
                         "or cffi pointer)")
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


def _callable_or_address(function: Any, name: str, count: int) -> Any:
    """The callable, or the address of a C function."""
    if function is None:
        return None
    if hasattr(function, "address") and hasattr(function, "native_name"):  # Numba's
        expected = "(float64*, float64*, int64) -> none" if count == 2 else "(float64*, int64) -> float64"
        signature = str(getattr(function, "_sig", expected))
        if signature != expected:
            raise ValueError(f"{name}: the cfunc is {signature}; allowed is {expected}")
        return int(function.address)
    if isinstance(function, ctypes._CFuncPtr):  # type: ignore[attr-defined]
        address = ctypes.cast(function, ctypes.c_void_p).value
        if not address:
            raise ValueError(f"{name}: the C function is a null pointer")
        return address
    if type(function).__module__ == "_cffi_backend":
        import _cffi_backend  # type: ignore[import]

        address = int(_cffi_backend.FFI().cast("intptr_t", function))
        if not address:
            raise ValueError(f"{name}: the C function is a null pointer")
        return address
    _require_arguments(function, name, count)
    return function
