"""Scenes: nodes, springs, gravity."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from qddot import _qddot
from qddot._arrays import Floats, flags, floats, frozen, number, whole_numbers
from qddot._curve import Curve, Curves, curve_of
from qddot._curve import held as held_curves
from qddot._names import hint, knows_its_arguments
from qddot._optional import require_package


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


def _list(values: Sequence[float]) -> str:
    return repr([float(x) for x in values])


def _quoted(text: str) -> str:
    """A string of TOML."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


# Nodes of a mesh: a box (min, max), the name or tag of a group, or an array of nodes.
Chosen = Union[Tuple[Sequence[float], Sequence[float]], str, int, NDArray[np.int64]]


def _choice(chosen: Chosen) -> list[str]:
    if isinstance(chosen, str):
        return [f"group = {_quoted(chosen)}"]
    if isinstance(chosen, (int, np.integer)):
        return [f"group = {int(chosen)}"]
    if isinstance(chosen, np.ndarray) and chosen.ndim == 1:
        return [f"nodes = {whole_numbers(chosen, 'nodes').tolist()}"]
    low, high = chosen
    return [f"min = {_list(low)}", f"max = {_list(high)}"]


def _of_handle(name: str, doc: str) -> Any:
    """A read-only property of a scene; arrays are read-only, too."""

    def value(scene: Scene) -> Any:
        held = getattr(scene._handle, name)
        return frozen(held) if isinstance(held, np.ndarray) else held

    return property(value, doc=doc)


class Scene:
    """A network of masses and springs, immutable.

    positions: (nodes, dimension) [m], dimension 1, 2 or 3. springs: (springs, 2), the nodes of
    each, from 0. stiffness [N/m], rest_length [m] (default: as drawn), cubic [N/m^2], quartic
    [N/m^3] and damping [N s/m], of a dashpot along it (defaults: none): of each spring, or one for
    all. pulls_only: whether a spring is a cable, without any force below its rest length.
    breaks_at: the strain at which it breaks (default: never). rigid: whether it is a rod, whose
    length stays rest_length. Likewise of each, or one. rods_above [N/m]: stiffer springs on a node
    that moves are rods. air_damping
    [1/s]: alpha of the air's force -alpha m v on each node. mass [kg]: of each node, or one for
    all; 0 is massless.
    pinned: the fixed nodes, by number or as a mask. gravity: (dimension) [m/s^2]. velocities: as
    positions [m/s]. load: constant forces on the nodes, as positions [N]. motion: a dict of pinned
    nodes and the Curve by which each is displaced [m]. load_in_time: a dict of other nodes and the
    Curve of a load beside `load` [N]. gravity_in_time: the Curve of an acceleration beside gravity.
    until [s]: the default
    end time of runs. stiff_above [N/m]: stiffer springs are the stiff ones for methods that
    separate these. starts_at_equilibrium: whether the motion begins at rest, downhill from the
    positions. Raises InvalidInput, with one sentence, for wrong input.
    """

    _handle: _qddot.Scene
    _start: _qddot.Scene | None
    _models: dict[tuple[object, ...], _qddot.Model]
    _drawn: _qddot.Drawn | None

    @knows_its_arguments
    def __init__(
        self,
        positions: ArrayLike,
        springs: ArrayLike,
        *,
        stiffness: ArrayLike,
        mass: ArrayLike,
        pinned: ArrayLike = (),
        gravity: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        load: ArrayLike | None = None,
        rest_length: ArrayLike | None = None,
        quartic: ArrayLike | None = None,
        damping: ArrayLike | None = None,
        cubic: ArrayLike | None = None,
        breaks_at: ArrayLike | None = None,
        pulls_only: ArrayLike | None = None,
        rigid: ArrayLike | None = None,
        rods_above: float | None = None,
        air_damping: float = 0,
        name: str = "scene",
        until: float | None = None,
        stiff_above: float | None = None,
        starts_at_equilibrium: bool = False,
        motion: Curves | None = None,
        load_in_time: Curves | None = None,
        gravity_in_time: Curve | None = None,
    ) -> None:
        places = floats(positions, "positions")
        for what, given in (("velocities", velocities), ("load", load)):
            if given is not None and np.shape(given) != places.shape:
                raise ValueError(
                    f"{what}: their shape is {np.shape(given)}; allowed is that of "
                    f"the positions, {places.shape}"
                )
        held = np.asarray(pinned)
        if held.dtype == bool:
            if held.shape != places.shape[:1]:
                raise ValueError(
                    f"pinned: the mask's shape is {held.shape}; allowed is a value for "
                    f"each of the {len(places)} nodes"
                )
            held = np.flatnonzero(held)
        held = whole_numbers(held, "pinned")
        if held.ndim != 1 or len(np.unique(held)) != held.size:
            raise ValueError(
                "pinned: allowed are the numbers of nodes, each once, or a mask of bool"
            )
        is_pinned = np.zeros(len(places), dtype=bool)
        is_pinned[held[(held >= 0) & (held < len(places))]] = True
        dimension = places.shape[1] if places.ndim == 2 else 0
        curves = held_curves(motion, load_in_time, gravity_in_time, is_pinned, dimension)
        self._hold(
            _qddot.Scene.from_arrays(
                places,
                whole_numbers(springs, "springs"),
                floats(mass, "mass", one=True),
                floats(stiffness, "stiffness", one=True),
                held,
                None if gravity is None else floats(gravity, "gravity"),
                None if velocities is None else floats(velocities, "velocities"),
                None if load is None else floats(load, "load"),
                None if rest_length is None else floats(rest_length, "rest_length", one=True),
                None if quartic is None else floats(quartic, "quartic", one=True),
                None if damping is None else floats(damping, "damping", one=True),
                None if cubic is None else floats(cubic, "cubic", one=True),
                None if breaks_at is None else floats(breaks_at, "breaks_at", one=True),
                None if pulls_only is None else flags(pulls_only, "pulls_only"),
                None if rigid is None else flags(rigid, "rigid"),
                None if rods_above is None else number(rods_above, "rods_above"),
                number(air_damping, "air_damping"),
                str(name),
                None if until is None else number(until, "until"),
                None if stiff_above is None else number(stiff_above, "stiff_above"),
                bool(starts_at_equilibrium),
                curves.records,
                curves.of_nodes,
                curves.of_gravity,
            )
        )

    def _hold(self, handle: _qddot.Scene) -> None:
        self._handle = handle
        self._start = None
        self._models = {}
        self._drawn = None

    @classmethod
    def _of(cls, handle: _qddot.Scene) -> Scene:
        scene = cls.__new__(cls)
        scene._hold(handle)
        return scene

    @classmethod
    def load(cls, name_or_path: str | os.PathLike[str]) -> Scene:
        """The scene of a TOML file, or of a generator with its default values."""
        return cls._of(_qddot.Scene.load(os.fspath(name_or_path)))

    @classmethod
    def from_toml(cls, text: str, folder: str | os.PathLike[str] = ".") -> Scene:
        """The scene of a TOML text; paths of meshes in it are relative to the folder."""
        return cls._of(_qddot.Scene.parse(text, "the text", os.fspath(folder)))

    @classmethod
    @knows_its_arguments
    def from_mesh(
        cls,
        file: str | os.PathLike[str],
        *,
        stiffness: float,
        node_mass: float | None = None,
        total_mass: float | None = None,
        density: float | None = None,
        bending_stiffness: float | None = None,
        scale: float | None = None,
        weld: float | None = None,
        rotation: Sequence[float] | None = None,
        shift: Sequence[float] | None = None,
        velocity: Sequence[float] | None = None,
        pins: Sequence[Chosen] = (),
        loads: Sequence[tuple[Chosen, Sequence[float]]] = (),
        gravity: Sequence[float] | None = None,
        until: float | None = None,
        damping_time: float | None = None,
        air_damping: float | None = None,
        pulls_only: bool = False,
        breaks_at: float | None = None,
        rods_above: float | None = None,
    ) -> Scene:
        """The scene of a mesh (.obj, MEDIT .mesh, Gmsh .msh, .ply, .stl): every edge is a spring at
        its rest length. Masses come from node_mass or total_mass [kg], or from density: [kg/m^3] of
        a mesh with volume, [kg/m^2] of a surface. `weld`: the distance [m] within which vertices
        become one. `rotation`: the axis to turn about, with the angle in degrees as its length;
        then `shift` [m] is added. `velocity` [m/s]: of all nodes at the start. `pins`: the nodes
        that are fixed, each entry a box (min, max), the name or tag of a group, or an array of
        nodes. `loads`: pairs of such nodes and the force on each of them [N]. `damping_time` [s]:
        that of a dashpot along each edge, over the edge's stiffness; `air_damping` [1/s]. `pulls_only`: whether edges are cables;
        `breaks_at`: the strain at which each breaks. `rods_above` [N/m]: stiffer springs are
        rods."""
        path = os.path.abspath(os.fspath(file))
        stem = os.path.splitext(os.path.basename(path))[0]
        lines = [f"name = {_quoted(stem)}"]
        if until is not None:
            lines.append(f"until = {float(until)!r}")
        if gravity is not None:
            lines.append(f"gravity = {_list(gravity)}")
        if rods_above is not None:
            lines.append(f"rods_above = {float(rods_above)!r}")
        lines += ["[mesh]", f"file = {_quoted(path)}"]
        numbers = dict(
            stiffness=stiffness,
            node_mass=node_mass,
            total_mass=total_mass,
            density=density,
            bending_stiffness=bending_stiffness,
            scale=scale,
            weld=weld,
            damping_time=damping_time,
            air_damping=air_damping,
            breaks_at=breaks_at,
        )
        if pulls_only:
            lines.append("pulls_only = true")
        lines += [f"{name} = {float(x)!r}" for name, x in numbers.items() if x is not None]
        vectors = dict(rotation=rotation, shift=shift, velocity=velocity)
        lines += [f"{name} = {_list(x)}" for name, x in vectors.items() if x is not None]
        for chosen in pins:
            lines += ["[[mesh.pin]]", *_choice(chosen)]
        for chosen, force in loads:
            lines += ["[[mesh.load]]", *_choice(chosen), f"force = {_list(force)}"]
        text = "\n".join(lines) + "\n"
        return cls._of(_qddot.Scene.parse(text, path, os.path.dirname(path)))

    name: str = _of_handle("name", "Its name.")
    dimension: int = _of_handle("dimension", "The coordinates of a node: 1, 2 or 3.")
    until: float | None = _of_handle("until", "The default end time of runs [s].")
    stiff_above: float | None = _of_handle(
        "stiff_above", "Springs with more stiffness than this [N/m] are the stiff ones."
    )
    starts_at_equilibrium: bool = _of_handle(
        "starts_at_equilibrium", "Whether its motion begins at rest, downhill from the positions."
    )
    warnings: list[str] = _of_handle("warnings", "Warnings from reading the scene.")
    positions: Floats = _of_handle("positions", "(nodes, dimension) [m].")
    velocities: Floats = _of_handle("velocities", "(nodes, dimension) [m/s].")
    mass: Floats = _of_handle("mass", "(nodes) [kg].")
    pinned: NDArray[np.bool_] = _of_handle("pinned", "(nodes), whether each is fixed.")
    loads: Floats = _of_handle("loads", "(nodes, dimension) [N], constant.")
    gravity: Floats = _of_handle("gravity", "(dimension) [m/s^2].")
    springs: NDArray[np.int64] = _of_handle("springs", "(springs, 2), the nodes of each.")
    stiffness: Floats = _of_handle("stiffness", "(springs) [N/m].")
    rest_length: Floats = _of_handle("rest_length", "(springs) [m].")
    quartic: Floats = _of_handle("quartic", "(springs) [N/m^3].")
    damping: Floats = _of_handle("damping", "(springs), of their dashpots [N s/m].")
    cubic: Floats = _of_handle("cubic", "(springs) [N/m^2].")
    breaks_at: Floats = _of_handle("breaks_at", "(springs), the strain at which each breaks.")
    pulls_only: NDArray[np.bool_] = _of_handle("pulls_only", "(springs), whether it is a cable.")
    rigid: NDArray[np.bool_] = _of_handle("rigid", "(springs), whether it is a rod.")
    air_damping: float = _of_handle("air_damping", "alpha of the force -alpha m v [1/s].")

    @property
    def motion(self) -> dict[int, Curve]:
        """The pinned nodes that move, and the Curve by which each is displaced [m]."""
        return self._curves(is_pinned=True)

    @property
    def load_in_time(self) -> dict[int, Curve]:
        """The other nodes with a load that changes, and its Curve [N]."""
        return self._curves(is_pinned=False)

    @property
    def gravity_in_time(self) -> Curve | None:
        """The Curve of an acceleration beside gravity [m/s^2], if there is one."""
        number = self._handle.curve_of_gravity
        return None if number < 0 else curve_of(self._handle.curves[number])

    def _curves(self, is_pinned: bool) -> dict[int, Curve]:
        numbers = self._handle.curve_of_node
        nodes = np.flatnonzero((numbers >= 0) & (self.pinned == is_pinned))
        if not nodes.size:
            return {}
        records = [curve_of(record) for record in self._handle.curves]
        return {int(node): records[numbers[node]] for node in nodes}

    def replace(self, **changes: Any) -> Scene:
        """The same scene with these arguments of Scene() replaced."""
        names = (
            "positions springs stiffness mass pinned gravity velocities load rest_length quartic "
            "damping cubic breaks_at pulls_only rigid air_damping name until stiff_above "
            "starts_at_equilibrium motion load_in_time gravity_in_time"
        ).split()
        for name in changes:
            if name not in names:
                raise ValueError(
                    f"replace: {name} is none of {', '.join(names)}{hint(name, names)}"
                )
        own = {name: getattr(self, "loads" if name == "load" else name) for name in names}
        return Scene(**{**own, **changes})

    def to_toml(self) -> str:
        """The text of a scene file that gives the same scene to the last bit."""
        return self._handle.to_toml()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes that scene file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.to_toml())

    def content_hash(self) -> str:
        """A hash of all that decides its motion, the same on every machine."""
        return self._handle.content_hash()

    def explain(self, keep: Sequence[str] = ()) -> Explanation:
        """The unknowns that remain, the reductions with their reasons, w_max and the largest stable
        step."""
        return Explanation(**self._model(keep=keep).explain())

    def force(self, q: ArrayLike | None = None) -> Floats:
        """f [N] on all nodes at the positions q [m], in the shape of q: (nodes, dimension) or
        (nodes * dimension); default: as drawn. Pinned nodes have none."""
        x = self._places(q)
        return self._as_drawn().force(x).reshape(x.shape)

    def potential(self, q: ArrayLike | None = None) -> float:
        """V [J] at these positions, with f = -dV/dq for all nodes that are not pinned."""
        return self._as_drawn().potential(self._places(q))

    def stiffness_matrix(self, q: ArrayLike | None = None) -> Any:
        """K = df/dq [N/m] at these positions: a scipy.sparse.csc_array, n x n with n = nodes *
        dimension, symmetric, with the same entries at every q. Unknown dimension * i + c is
        coordinate c of node i. Rows and columns of pinned nodes are zero. Nothing is left out, as
        model() does. Raises ImportError if SciPy is missing."""
        require_package("scipy", "stiffness_matrix makes a matrix of")
        import scipy.sparse  # type: ignore

        data, rows, first = self._as_drawn().stiffness(self._places(q))
        n = self.positions.size
        columns = np.repeat(np.arange(n), np.diff(first))
        below = rows != columns
        i = np.concatenate((rows, columns[below]))
        j = np.concatenate((columns, rows[below]))
        entries = np.concatenate((data, data[below]))
        return scipy.sparse.coo_array((entries, (i, j)), (n, n)).tocsc()

    def _places(self, q: ArrayLike | None) -> Floats:
        shape = self.positions.shape
        x = self.positions if q is None else floats(q, "q")
        if x.shape not in (shape, (x.size,)) or x.size != self.positions.size:
            raise ValueError(
                f"q: its shape is {x.shape}; allowed is that of all nodes, {shape} or "
                f"({self.positions.size})"
            )
        return x

    def _as_drawn(self) -> _qddot.Drawn:
        if self._drawn is None:
            self._drawn = _qddot.Drawn(self._handle)
        return self._drawn

    def model(self, keep: Sequence[str] = ()) -> _qddot.Model:
        """The smallest system with the motion of the scene, over its unknowns q: mass, force(q),
        potential(q) and stiffness(q), as (data, indices, indptr) of its lower triangle. nodes_at(q,
        v, t) has all nodes. `keep`: reductions to leave out."""
        return self._model(keep=keep)

    def _started(self) -> _qddot.Scene:
        if self._start is None:
            self._start = self._handle.started()
        return self._start

    def _model(
        self, method: str | None = None, accepts_massless: bool = False, keep: Sequence[str] = ()
    ) -> _qddot.Model:
        # The reductions that a method allows depend on these properties alone.
        key = (accepts_massless, *sorted(keep))
        if key not in self._models:
            name = method if accepts_massless else None
            self._models[key] = _qddot.model_of(self._started(), name, list(keep))
        return self._models[key]

    def __reduce__(self) -> tuple[Any, ...]:
        return (Scene.from_toml, (self.to_toml(),))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.content_hash() == other.content_hash()

    def __hash__(self) -> int:
        return hash(self.content_hash())

    def __repr__(self) -> str:
        nodes, springs = len(self.mass), len(self.stiffness)
        return f"<qddot.Scene {self.name!r}: {nodes} nodes, {springs} springs, {self.dimension}D>"
