"""Your own M q'' = f(q), by Python callables or, at full speed, by C functions."""

from __future__ import annotations

import ctypes
import importlib
import inspect
from typing import Any, Callable, Iterator, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from qddot import _qddot
from qddot._arrays import Floats, floats, frozen, number, whole_numbers
from qddot._names import knows_its_arguments

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Pattern = tuple[NDArray[np.int64], NDArray[np.int64]]


# The allowed error of differences. Those of second order have errors of about 1e-10 for a smooth V;
# a wrong sign or factor gives far larger ones.
TOLERANCE = 1e-4
# The relative rounding error of sums.
ROUNDING = 1e-12
# Up to FEW unknowns each force is checked by itself; more are checked along DIRECTIONS directions.
FEW, DIRECTIONS = 100, 3
AS_IT_IS = "(check=False takes it as it is)"


def check(
    model: _qddot.Model,
    length: float,
    has_own_stiffness: bool,
    linear: bool,
    damping: Callable[[Floats], Any] | None,
) -> None:
    """Compares f, V and K with each other's differences beside the start, where no symmetry hides
    anything; and those of a linear system at some distance. `length` [m]: a small length there. The
    C of `damping` must be symmetric and take energy."""
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
    elif x.size > 1:
        for _ in range(DIRECTIONS):
            _check_gradient(model, x, d, random.uniform(-1, 1, (2, x.size)))
    if model.has_stiffness:
        u = random.uniform(-1, 1, x.size)
        _check_stiffness(model, x, u, d, has_own_stiffness)
        if linear:
            _check_linear(model, x, length * u)
    if damping is not None:
        _check_damping(damping(x), x.size, random)


def _directions(n: int, random: np.random.Generator) -> Iterator[Floats]:
    if n <= FEW:
        yield from np.eye(n)
        return
    for _ in range(DIRECTIONS):
        yield random.uniform(-1, 1, n)


def _check_energy(model: _qddot.Model, x: Floats, u: Floats, d: float) -> None:
    ahead, behind = model.force(x + d * u), model.force(x - d * u)
    fall = (model.potential(x - d * u) - model.potential(x + d * u)) / (2 * d)
    # Simpson's rule, as a force may vanish at the start and curve beside it.
    work = float((ahead + 4 * model.force(x) + behind) @ u) / 6
    size = float((np.abs(ahead) + np.abs(ahead - behind)) @ np.abs(u))
    size += (abs(fall) + abs(work)) / 2
    rounding = ROUNDING * (abs(model.potential(x)) + d * float(np.max(np.abs(ahead)))) / d
    if not abs(fall - work) <= TOLERANCE * size + rounding:
        raise ValueError(
            f"potential: beside the start it falls by {fall:.6g} J/m where the force does "
            f"{work:.6g} J/m; f is -dV/dq {AS_IT_IS}"
        )


def _check_gradient(model: _qddot.Model, x: Floats, d: float, pair: Floats) -> None:
    """The derivative of a gradient is symmetric: u . df/dq v = v . df/dq u."""
    along = [(model.force(x + d * u) - model.force(x - d * u)) / (2 * d) for u in pair]
    one, other = float(pair[0] @ along[1]), float(pair[1] @ along[0])
    size = float(np.abs(pair[0]) @ np.abs(along[1]) + np.abs(pair[1]) @ np.abs(along[0]))
    rounding = ROUNDING * float(np.sum(np.abs(model.force(x)))) / d
    if not abs(one - other) <= TOLERANCE * size + rounding:
        raise ValueError(
            f"force: it is no gradient of a potential: beside the start df/dq is not symmetric, "
            f"with {one:.6g} and {other:.6g} N/m for the same two directions {AS_IT_IS}"
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


def _check_linear(model: _qddot.Model, x: Floats, step: Floats) -> None:
    here, there = model.force(x), model.force(x + step)
    change, k, k_there = there - here, _times(model, x, step), _times(model, x + step, step)
    largest = float(max(np.max(np.abs(here)), np.max(np.abs(there)), np.max(np.abs(k))))
    size = TOLERANCE * float(np.max(np.abs(k))) + ROUNDING * largest
    for other, what in ((change, "the force changes"), (k_there, "K changes")):
        if not np.max(np.abs(other - k)) <= size:
            i = int(np.argmax(np.abs(other - k)))
            raise ValueError(
                f"linear: K is not the same everywhere: over a step away from the start {what} by "
                f"{other[i]:.6g} N instead of {k[i]:.6g} N {AS_IT_IS}"
            )


def _check_damping(given: Any, n: int, random: np.random.Generator) -> None:
    c = given.toarray() if hasattr(given, "toarray") and n <= FEW else given
    if not hasattr(c, "tocsc"):
        c = np.asarray(c, dtype=np.float64)
    difference, largest = abs(c - c.T).max(), abs(c).max()
    if not difference <= TOLERANCE * largest:
        raise ValueError(
            f"damping: beside the start C is not symmetric: two entries differ by {difference:.6g} "
            f"N s/m {AS_IT_IS}"
        )
    for u in random.uniform(-1, 1, (20 if n > FEW else 0, n)):
        _require_loss(float(u @ (c @ u)) / float(u @ u), largest)
    if n <= FEW:
        _require_loss(float(np.linalg.eigvalsh(c)[0]), largest)


def _require_loss(least: float, largest: float) -> None:
    if not least >= -TOLERANCE * largest:
        raise ValueError(
            f"damping: beside the start C has the eigenvalue {least:.6g} N s/m or less, so that it "
            f"adds energy; the force is -C v {AS_IT_IS}"
        )


def _times(model: _qddot.Model, x: Floats, u: Floats) -> Floats:
    data, rows, first = model.stiffness(x)
    columns = np.repeat(np.arange(x.size), np.diff(first))
    product = np.zeros_like(x)
    np.add.at(product, rows, data * u[columns])
    below = rows != columns
    np.add.at(product, columns[below], data[below] * u[rows[below]])
    return product


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
        if count == 2 and len(signature.parameters) == 1:
            raise ValueError(
                f"{name}: it takes {signature}; it is called as {name}(q, f) and writes f, as by "
                "f[:] = -q, so that no memory is allocated in each step"
            ) from None
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
        # mypy knows its types on some systems alone.
        foreign = importlib.import_module("_cffi_backend").FFI()
        kind = foreign.typeof(function)
        if kind.kind != "function" or len(kind.args) != count + 1:
            raise ValueError(f"{name}: it is {kind.cname}; allowed is {c_type}")
        address = int(foreign.cast("intptr_t", function))
        if not address:
            raise ValueError(f"{name}: the C function is a null pointer")
        return address
    require_arguments(function, name, count)
    return function


def length_of(value: Any) -> float:
    """A length [m] above 0."""
    x = number(value, "length")
    if not (np.isfinite(x) and x > 0):
        raise ValueError(f"length {value} is not allowed; it is a length in m above 0")
    return x


def _is_matrix(stiffness: Any) -> bool:
    return hasattr(stiffness, "tocsc") or isinstance(stiffness, (np.ndarray, list, tuple))


class System:
    """Your own forces: M q'' = f(q), with f = -dV/dq.

    mass [kg]: (n); or (nodes) or (nodes, dimension), if a dimension 1, 2 or 3 is given. q and f
    have the shape (n), or (nodes, dimension).

    force(q, f) writes f [N]. potential(q) returns V [J]. stiffness(q) returns K = df/dq [N/m], n x
    n and symmetric, as a scipy.sparse matrix or an array; mind the sign, many codes have -K. A
    stiffness that is a matrix itself is the same everywhere: the system is linear. q and f are
    views of the solver's memory: q is read-only, and neither may be kept after the call. force and
    potential may also be C functions (a Numba cfunc, a ctypes or cffi pointer), which
    cost no more than those of qddot:
        void force(const double* q, double* f, int64_t n);
        double potential(const double* q, int64_t n);

    What you give decides what you can use:
    - force: explicit methods,
    - potential: energies, and a line search in implicit methods,
    - stiffness or `pattern`: implicit methods, SUNDIALS', references, answers to an accuracy,
    - damping(q), beside one of these: C [N s/m], like K in form and with no entry that K has not,
      symmetric and positive semidefinite. The force is then f - C v, and energies have the part
      that it takes. A matrix itself is the same everywhere, as it must be in a linear system.
    A pattern has the nonzeros of K, which then is made of differences of f: a sparse or dense
    matrix of n x n unknowns or of nodes x nodes, pairs (m, 2) of unknowns, or "dense".
    `linear` says that K is the same everywhere: it is then made once, and the method `exact` knows
    the motion.

    `length` [m]: a small length of the motion, for these differences; default: the extent of the
    start. `check`: whether the system is checked beside its first start: f must be finite and equal
    -dV/dq or, without V, have a symmetric df/dq, K must agree with differences of f, and a linear
    f must be so; C must be symmetric and take energy. `name`: its name in charts, files and
    messages. Other forces that depend on the velocity or on time are not modelled: a force that
    takes them is refused.
    """

    @knows_its_arguments
    def __init__(
        self,
        mass: ArrayLike,
        force: Any,
        potential: Any = None,
        stiffness: Any = None,
        pattern: Any = None,
        *,
        damping: Any = None,
        dimension: int | None = None,
        length: float | None = None,
        check: bool = True,
        linear: bool = False,
        name: str = "system",
    ) -> None:
        if not isinstance(name, str) or not name:
            raise ValueError(f"name: {name!r} is no name")
        if dimension not in (None, 1, 2, 3):
            raise ValueError(f"dimension {dimension} is not allowed; it is 1, 2, 3 or None")
        m = floats(mass, "mass", one=True)
        if dimension is not None and m.ndim == 1:
            m = np.repeat(m[:, None], dimension, axis=1)
        if m.ndim != (1 if dimension is None else 2) or m.shape[1:] not in ((), (dimension,)):
            raise ValueError(
                f"mass: its shape is {m.shape}; allowed are (n), or (nodes) and (nodes, "
                "dimension) with a dimension"
            )
        if not np.all(np.isfinite(m)) or np.any(m < 0) or m.size == 0:
            raise ValueError("mass: allowed are finite numbers of at least 0 in kg, one or more")
        if length is not None:
            length = length_of(length)
        self._mass = frozen(m.copy())
        self._dimension = dimension
        self._length = length
        self._force = callable_or_address(force, "force", 2)
        self._potential = callable_or_address(potential, "potential", 1)
        self._name = name
        self._linear = bool(linear)
        self._stiffness: Callable[[Floats], Any] | None = None
        if stiffness is not None and _is_matrix(stiffness):
            constant = self._constant(stiffness, "stiffness")
            self._stiffness, self._linear = lambda q: constant, True
        elif stiffness is not None and not callable(stiffness):
            raise ValueError("stiffness: it is neither a callable nor a matrix")
        elif stiffness is not None:
            require_arguments(stiffness, "stiffness", 1)
            self._stiffness = stiffness
        elif linear and pattern is None:
            raise ValueError(
                "linear: the System has no K; give it its stiffness, or a pattern of it"
            )
        self._damping: Callable[[Floats], Any] | None = None
        if damping is not None and stiffness is None and pattern is None:
            raise ValueError(
                "damping: C has the pattern of K; give the System its stiffness, or a pattern of it"
            )
        if damping is not None and _is_matrix(damping):
            constant_damping = self._constant(damping, "damping")
            self._damping = lambda q: constant_damping
        elif damping is not None:
            require_arguments(damping, "damping", 1)
            if self._linear:
                raise ValueError(
                    "damping: of a linear system C is the same everywhere; allowed is a matrix"
                )
            self._damping = damping
        self._kept_alive = (force, potential)
        self._pattern: Pattern | None = None if pattern is None else self._pairs(pattern)
        self._must_check = check

    @property
    def name(self) -> str:
        """Its name in charts, files and messages."""
        return self._name

    @property
    def linear(self) -> bool:
        """Whether K is the same everywhere."""
        return self._linear

    @property
    def mass(self) -> Floats:
        """[kg], in the shape of q and f."""
        return self._mass

    @property
    def dimension(self) -> int | None:
        """The number of coordinates of a node; None if there are no nodes."""
        return self._dimension

    @property
    def length(self) -> float:
        """A small length of the motion [m]: the one that was given, or else the extent of the first
        start."""
        return self._length or 1.0

    @property
    def has_potential(self) -> bool:
        """Whether it computes V."""
        return self._potential is not None

    @property
    def has_stiffness(self) -> bool:
        """Whether K is computed, or made of differences."""
        return self._stiffness is not None or self._pattern is not None

    def _constant(self, matrix: Any, name: str) -> Any:
        """A copy of a constant K or C. Raises ValueError if it is not n x n, finite and symmetric."""
        n = self.mass.size
        k = matrix.tocsc() if hasattr(matrix, "tocsc") else floats(matrix, name)
        if k.shape != (n, n):
            raise ValueError(f"{name}: its shape is {k.shape}; allowed is {(n, n)}")
        if not np.all(np.isfinite(k.data if hasattr(k, "tocsc") else k)):
            raise ValueError(f"{name}: some of its entries are not finite")
        if abs(k - k.T).max() > ROUNDING * abs(k).max():
            whose = "the K of a potential" if name == "stiffness" else "the C of damping"
            raise ValueError(f"{name}: it is not symmetric, as {whose} is")
        return k.copy()

    def _pairs(self, pattern: Any) -> Pattern:
        n = self.mass.size
        rows, columns = self._entries(pattern)
        beyond = (rows < 0) | (rows >= n) | (columns < 0) | (columns >= n)
        if np.any(beyond):
            i = int(np.flatnonzero(beyond)[0])
            raise ValueError(
                f"pattern: entry ({rows[i]}, {columns[i]}) is not among the {n} unknowns"
            )
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
            if array.ndim != 2 or array.dtype.kind not in "biuf":
                raise ValueError(
                    f"pattern: it is no matrix and no table of pairs (m, 2), but of shape "
                    f"{array.shape}"
                )
            if array.shape[1] == 2 and array.shape != (2, 2):
                shape, (rows, columns) = (n, n), whole_numbers(array, "pattern").T
            elif array.shape == (2, 2) and n != 2 and len(self.mass) != 2:
                shape, (rows, columns) = (n, n), whole_numbers(array, "pattern").T
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
        assert self._stiffness is not None
        return self._in_columns(self._stiffness(q), q, "stiffness")

    def _damping_columns(self, q: Floats) -> Any:
        assert self._damping is not None
        return self._in_columns(self._damping(q), q, "damping")

    @staticmethod
    def _in_columns(k: Any, q: Floats, name: str) -> Any:
        """K or C in the form that the extension takes: dense, or (data, indices, indptr) of its
        sorted columns."""
        if not hasattr(k, "tocsc"):
            return np.asarray(k, dtype=np.float64)
        # Rows serve as columns, as K is symmetric. The caller's own matrix is not changed.
        if k.format not in ("csr", "csc"):
            k = k.tocsc()
        if not k.has_canonical_format:
            k = k.copy()
            k.sum_duplicates()
        if k.shape != (q.size, q.size):
            raise ValueError(
                f"{name}: it returned {k.shape[0]} x {k.shape[1]} numbers; allowed "
                f"is {q.size} x {q.size}"
            )
        return k.data, k.indices, k.indptr

    def _model(self, q0: ArrayLike | None, v0: ArrayLike | None) -> _qddot.Model:
        """The system from that start."""
        q = self._numbers(q0, "q0")
        v = np.zeros_like(q) if v0 is None else self._numbers(v0, "v0")
        if self._length is None:
            self._length = _size_of(q)
        if self._stiffness is not None and self._pattern is None:
            self._pattern = self._pattern_near(q)
        model = self._made(q, v)
        if self._must_check:
            check(
                model, self._length, self._stiffness is not None, self._linear, self._damping
            )
            self._must_check = False
        return model

    def _made(self, q: Floats, v: Floats) -> _qddot.Model:
        assert self._length is not None
        return _qddot.own_model(
            self.mass.reshape(-1),
            list(self.mass.shape),
            self._force,
            self._potential,
            None if self._stiffness is None else self._columns,
            None if self._damping is None else self._damping_columns,
            self._pattern,
            self._length,
            q.reshape(-1),
            v.reshape(-1),
            self.dimension or 1,
            self._linear,
        )

    def _numbers(self, value: ArrayLike | None, name: str) -> Floats:
        if value is None:
            raise ValueError(f"{name} is missing; a System starts there, {self.mass.shape} numbers")
        array = floats(value, name)
        if not np.all(np.isfinite(array)):
            raise ValueError(f"{name}: some of its entries are not finite")
        if array.shape != self.mass.shape:
            raise ValueError(
                f"{name}: its shape is {array.shape}; allowed is {self.mass.shape}, that "
                "of the masses"
            )
        return array

    def _pattern_near(self, q: Floats) -> Pattern:
        """The entries of K at q and beside it, where none is zero by symmetry."""
        beside = np.random.default_rng(0).uniform(0.5, 1, q.shape) * 1e-3 * (self._length or 1.0)
        rows, columns = [], []
        for place in (q.copy(), q + beside):
            place.setflags(write=False)
            k = self._columns(place)
            if not isinstance(k, tuple):
                return self._pairs("dense")
            rows.append(np.asarray(k[1], dtype=np.int64))
            columns.append(np.repeat(np.arange(q.size, dtype=np.int64), np.diff(k[2])))
        return np.concatenate(rows), np.concatenate(columns)

    def __repr__(self) -> str:
        offered = ["force"]
        offered += ["potential"] if self.has_potential else []
        offered += ["stiffness"] if self._stiffness is not None else []
        offered += ["pattern"] if self._stiffness is None and self.has_stiffness else []
        offered += ["damping"] if self._damping is not None else []
        kind = ", linear" if self.linear else ""
        return (
            f"<qddot.System {self.name!r}: {self.mass.size} unknowns{kind}; {', '.join(offered)}>"
        )


def _size_of(q: Floats) -> float:
    """The extent of the start; the size of the number if there is only one; else 1."""
    spread = float(np.max(np.ptp(q, axis=0))) if len(q) > 1 else 0.0
    return spread or float(np.max(np.abs(q))) or 1.0
