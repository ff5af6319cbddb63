"""Reads .vtkhdf files of simulate back: layout, values, virtual datasets and the .xdmf."""

import glob
import tomllib

import h5py
import numpy as np

from motion_case import (
    DIVERGING, FLOAT, SHORT, Motions, assert_close, mixed_cells, run_words, xdmf_frames,
)  # fmt: skip
from programs import node, read, rows_of, scene, sidecar, spring, write

FIELDS = ["kinetic_energy", "velocity"]
KINDS = {"Vertices": 1, "Lines": 2, "Polygons": 3, "Strips": 1}


def cells_of(root, kind):
    """The cells of a kind; checks the counts that the layout asks for."""
    group = root[kind]
    offsets, nodes = group["Offsets"][...], group["Connectivity"][...]
    assert group["NumberOfCells"][...].tolist() == [len(offsets) - 1]
    assert group["NumberOfConnectivityIds"][...].tolist() == [len(nodes)]
    assert offsets.tolist() == list(range(0, len(nodes) + 1, KINDS[kind]))
    return [tuple(cell) for cell in nodes.reshape(-1, KINDS[kind]).tolist()]


def check_layout(root, frames, nodes, cells):
    """The layout of PolyData over time in VTKHDF 2.0, with topology that is there once."""
    assert root.attrs["Version"].tolist() == [2, 0]
    kind = root.attrs.get_id("Type").get_type()
    assert root.attrs["Type"] == b"PolyData"
    assert not kind.is_variable_str() and kind.get_cset() == h5py.h5t.CSET_ASCII
    assert root["NumberOfPoints"][...].tolist() == [nodes]
    assert root["Points"].shape == (frames * nodes, 3) and root["Points"].dtype == "<f4"
    steps = root["Steps"]
    assert steps.attrs["NSteps"] == frames and steps["Values"].shape == (frames,)
    assert steps["NumberOfParts"][...].tolist() == [1] * frames
    assert steps["PartOffsets"][...].tolist() == [0] * frames
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        assert steps[name].shape == (frames, 4) and not steps[name][...].any()
    assert steps["PointOffsets"][...].tolist() == [k * nodes for k in range(frames)]
    for kind, count in ("PointData", nodes), ("CellData", cells):
        offsets = steps[f"{kind}Offsets"]
        assert sorted(offsets) == sorted(root[kind])
        for name, data in root[kind].items():
            assert data.shape == (frames * count, *([3] if name == "velocity" else []))
            assert offsets[name][...].tolist() == [k * count for k in range(frames)]


def strains_of(drawn, positions):
    """(l - length) / length, by the rest length or, where it is zero, the length at the start."""
    result = np.zeros((len(positions), len(drawn["springs"])))
    for k, one in enumerate(drawn["springs"]):
        a, b = one["nodes"]
        lengths = np.linalg.norm(positions[:, b] - positions[:, a], axis=1)
        by = one.get("rest_length") or lengths[0]
        if by > 0:
            result[:, k] = (lengths - by) / by
    return result


def check_strains(found, drawn, positions, first_line):
    """Strain is a difference of lengths, so that their rounding (17 digits in the table, whole
    doubles in the run: some 1e-15) counts beside that of the number itself."""
    wanted = strains_of(drawn, positions)
    lines = found[:, first_line : first_line + wanted.shape[1]]
    assert (np.abs(lines - wanted) <= SHORT * np.abs(wanted) + 1e-14).all()
    assert not found[:, :first_line].any() and not found[:, first_line + wanted.shape[1] :].any()


def same_numbers(a, b):
    """Whether two arrays are the same; a spring that is broken has NaN in both."""
    return np.array_equal(a, b, equal_nan=True)


def check_frames(stem, root_file, times):
    """The virtual datasets are the rows, and the .xdmf names them whole."""
    root = root_file["VTKHDF"]
    frames = xdmf_frames(stem + ".xdmf")
    assert [time for time, _ in frames] == times.tolist()
    data = {"Points": root["Points"], **root["PointData"], **root["CellData"]}
    for k, (_, found) in enumerate(frames):
        group = root_file[f"Frames/{k:06}"]
        assert sorted(group) == sorted(data)
        for name, rows in data.items():
            count = len(rows) // len(frames)
            assert group[name].is_virtual
            assert same_numbers(group[name][...], rows[k * count : (k + 1) * count])
            assert same_numbers(found[name], group[name][...])
        assert np.array_equal(found["position"], found["Points"])
        wanted = [cell for kind in KINDS for cell in cells_of(root, kind)]
        assert mixed_cells(found["Topology"]) == wanted


def cloth_faces(n):
    """Two triangles a square of the net."""
    corners = [i * n + j for i in range(n - 1) for j in range(n - 1)]
    halves = (0, n, n + 1), (0, n + 1, 1)
    return [tuple(corner + k for k in half) for corner in corners for half in halves]


def large_scene(n):
    """The nodes and springs of a net that all move differently, so that no two strains are equal."""
    velocities = np.random.default_rng(1).uniform(-0.1, 0.1, (n * n, 3)).tolist()
    nodes = [node(k // n, k % n, 0, velocity=v, mass=1) for k, v in enumerate(velocities)]
    springs = [
        spring(i * n + j, (i + di) * n + j + dj, 100)
        for i in range(n)
        for j in range(n)
        for di, dj in [(1, 0), (0, 1), (1, 1)]
        if i + di < n and j + dj < n
    ]
    return {"nodes": nodes, "springs": springs}


class Vtkhdf(Motions):
    def check_scene(self, name, faces=(), loose=(), drawn=None):
        """All of a motion against the table of the same run."""
        stem = "m_" + name
        times, positions, velocities = self.table_of(run_words(name, f"--motion {stem}.vtkhdf"))
        if not drawn:
            self.done(f"simulate --scene {name}.toml --write-scene written.toml")
            drawn = tomllib.loads(read("written.toml"))
        frames, nodes = positions.shape[:2]
        with h5py.File(stem + ".vtkhdf") as file:
            root = file["VTKHDF"]
            springs = [tuple(one["nodes"]) for one in drawn["springs"]]
            assert cells_of(root, "Lines") == springs
            assert cells_of(root, "Polygons") == list(faces)
            assert cells_of(root, "Vertices") == [(number,) for number in loose]
            assert cells_of(root, "Strips") == []
            check_layout(root, frames, nodes, len(loose) + len(springs) + len(faces))
            assert np.array_equal(root["Steps/Values"][...], times)
            assert_close(root["Points"][...].reshape(positions.shape), positions, FLOAT)
            assert sorted(root["PointData"]) == FIELDS
            found = root["PointData/velocity"][...].reshape(velocities.shape)
            assert_close(found, velocities, SHORT)
            masses = [0 if one.get("pinned") else one["mass"] for one in drawn["nodes"]]
            energies = 0.5 * np.array(masses) * (velocities**2).sum(axis=2)
            found = root["PointData/kinetic_energy"][...].reshape(frames, nodes)
            # Squares and sums round in doubles, far below SHORT.
            assert_close(found, energies, SHORT * 1.0001)
            found = root["CellData/strain"][...].reshape(frames, -1)
            check_strains(found, drawn, positions, len(loose))
            check_frames(stem, file, times)
        self.assertEqual(sidecar(stem + ".vtkhdf.json")["outcome"], "reached_end")

    def test_scenes_of_every_kind(self):
        self.check_scene("cloth", cloth_faces(5))
        self.check_scene("plane", loose=[3])
        self.check_scene("line")
        self.check_scene("massless")
        self.check_scene("meshed", [(0, 1, 2), (0, 2, 3)])
        self.assertEqual(glob.glob("*.part"), [])

    def test_the_strain_of_a_broken_spring_is_no_number(self):
        words = "--method verlet --step-size 1e-3 --until 0.3 --every 0.02 --breaks breaks.csv"
        times, positions, _ = self.table_of(f"--scene breaking.toml {words} --motion b.vtkhdf")
        drawn = tomllib.loads(read("breaking.toml"))
        (broken,) = rows_of(read("breaks.csv"))
        self.assertEqual(broken["spring"], 1)
        with h5py.File("b.vtkhdf") as file:
            found = file["VTKHDF/CellData/strain"][...].reshape(len(times), -1)
            check_frames("b", file, times)
        # The node on no spring is the first cell.
        self.assertEqual(found.shape, (len(times), 3))
        after = times > broken["t"]
        self.assertTrue(0 < after.sum() < len(times) - 1)
        self.assertTrue(np.array_equal(np.isnan(found[:, 2]), after))
        whole = drawn | {"springs": drawn["springs"][:1]}
        check_strains(found[:, :2], whole, positions, 1)
        check_strains(found[~after], drawn, positions[~after], 1)

    def test_fields_that_are_not_named_are_left_out(self):
        for fields, kept in ("strain", ["strain"]), ("none", []):
            words = f"--motion f.vtkhdf --motion-fields {fields}"
            self.done("simulate " + run_words("cloth", words))
            with h5py.File("f.vtkhdf") as file:
                self.assertEqual(list(file["VTKHDF/PointData"]), [])
                self.assertEqual(list(file["VTKHDF/CellData"]), kept)
                self.assertEqual(sorted(file["Frames/000000"]), ["Points", *kept])

    def test_frames_fill_several_chunks_the_last_one_in_part(self):
        words = "--scene pair --method verlet --step-size 1e-3 --until 9 --every 2e-3"
        _, positions, velocities = self.table_of(words + " --motion many.vtkhdf")
        with h5py.File("many.vtkhdf") as file:
            points, velocity = file["VTKHDF/Points"], file["VTKHDF/PointData/velocity"]
            assert len(points) > 2 * points.chunks[0] and len(points) % points.chunks[0] > 0
            assert_close(points[...].reshape(positions.shape), positions, FLOAT)
            assert_close(velocity[...].reshape(velocities.shape), velocities, SHORT)
            assert_close(file["Frames/004500/Points"][...], positions[-1], FLOAT)

    def test_a_frame_of_several_chunks_is_filled_by_several_threads(self):
        drawn = large_scene(190)
        write("large.toml", scene(**drawn))
        self.check_scene("large", drawn=drawn)
        with h5py.File("m_large.vtkhdf") as file:
            root = file["VTKHDF"]
            strain, lines = root["CellData/strain"], root["Lines/Connectivity"]
            assert strain.chunks[0] < len(file["Frames/000000/strain"])
            assert len(lines) > 2 * lines.chunks[0]
            points = root["Points"][...]
        words = "--motion alone.vtkhdf --motion-fields none"
        self.done("simulate " + run_words("large", words))
        with h5py.File("alone.vtkhdf") as file:
            assert file["VTKHDF/Points"].compression is None
            assert np.array_equal(file["VTKHDF/Points"][...], points)

    def test_a_run_that_grows_without_bound_leaves_the_frames_that_are_numbers(self):
        _, positions, velocities = self.table_of(f"{DIVERGING} --motion d.vtkhdf", status=3)
        with h5py.File("d.vtkhdf") as file:
            root = file["VTKHDF"]
            frames = int(root["Steps"].attrs["NSteps"])
            assert 1 < frames <= len(positions)
            found = root["Points"][...]
            assert_close(found.reshape(frames, -1, 3), positions[:frames], FLOAT)
            for data in (found, *(root["PointData"][name][...] for name in FIELDS)):
                assert np.isfinite(data).all()
        self.assertEqual(len(xdmf_frames("d.xdmf")), frames)
        # The next frame's kinetic energies would be beyond 32-bit floats.
        if frames < len(positions):
            assert (velocities[frames] ** 2).sum(axis=1).max() * 0.5 / 25 > np.finfo("f4").max / 2
