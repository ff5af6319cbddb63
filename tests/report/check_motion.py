"""Whether a motion at one's own step size is shown as it is: its picture, its page and what is refused.
The programs are in the folder QDDOT_BIN."""

import contextlib
import io
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import motion
import picture
import runs
from packed_folder import Page
from programs import BIN, node, pin, scene, spring, write


class Shown(unittest.TestCase):
    """A folder for what is shown."""

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.enterContext(mock.patch.object(runs, "SIMULATE", os.path.join(BIN, "simulate")))

    def show(self, words):
        """The exit status, the words on stderr, and the sheet that was drawn."""
        sheets = []

        def draw(*what):
            sheets.append(picture.draw_motion(*what))
            return sheets[-1]

        with contextlib.redirect_stderr(io.StringIO()) as said:
            with mock.patch.object(motion, "draw_motion", draw):
                try:
                    status = motion.main([str(self.folder), *words.split()])
                except SystemExit as refused:
                    status = refused.code
        return status, said.getvalue(), sheets[0] if sheets else None

    def shown(self, words):
        """The page, and the axes of the picture by the words beside them; all have numbers."""
        status, said, sheet = self.show(words)
        self.assertEqual((status, said), (0, ""))
        self.assertEqual((self.folder / "motion.png").read_bytes()[1:4], b"PNG")
        self.assertTrue((self.folder / "motion.svg").exists())
        axes = sheet.figure.axes
        for one in axes:
            # Outlines beside each other share the numbers of the first.
            shown = [one.xaxis, *([one.yaxis] if one.get_ylabel() else [])]
            for axis in shown:
                self.assertGreater(len([t for t in axis.get_ticklabels() if t.get_text()]), 1)
        return Page(self.folder / "motion.html"), axes


class OneMass(Shown):
    """One mass, whose motion formulas tell."""

    def test_the_energies_of_euler_s_methods_are_those_of_the_formulas(self):
        # Each step multiplies the energy by 1 + (h omega)^2 or divides it by that; omega is 10 / s.
        page, axes = self.shown(
            "--scene oscillator --methods explicit_euler,implicit_euler --step-size 0.05 --until 1"
        )
        exact, explicit, implicit = page.data["motion"]["runs"]
        steps = np.arange(21)
        for run, factor in ((explicit, 1.25), (implicit, 1 / 1.25)):
            np.testing.assert_allclose(run["times"], 0.05 * steps, atol=1e-12)
            # The solver's tolerance, far above the rounding of 20 steps.
            np.testing.assert_allclose(run["energy"]["total"], 50 * factor**steps, rtol=1e-6)
        self.assertEqual(exact["role"], "reference")
        # It starts at rest at 1 m; numbers of the page have five digits.
        (position,), (velocity,) = exact["phase"]["position"], exact["phase"]["velocity"]
        times = np.array(exact["times"])
        np.testing.assert_allclose(position, np.cos(10 * times), atol=1e-4)
        # Velocities of a motion's file are rounded by 2^-8 of themselves.
        np.testing.assert_allclose(velocity, -10 * np.sin(10 * times), atol=10 * 2**-8)
        # The largest displacement from the start is 2 m.
        amplitude = (1 + 0.5j) ** -20
        wanted = abs(amplitude.real - np.cos(10)) / 2
        self.assertAlmostEqual(page.data["points"]["error_position"][1], wanted, delta=1e-3)
        labels = [(one.get_xlabel(), one.get_ylabel()) for one in axes]
        self.assertEqual(labels[0], ("t in s", "x in m"))
        self.assertEqual(labels[2], ("x in m", "velocity along x in m/s"))
        self.assertEqual(labels[1][0], "t in s")
        self.assertIn("--step-size 0.05 --until 1.0", page.data["command"][0])

    def test_a_mass_in_space_has_a_phase_plane_for_each_axis(self):
        _, axes = self.shown("--scene orbit --methods verlet --step-size 0.05 --until 1")
        labels = [one.get_ylabel() for one in axes]
        self.assertEqual(labels[0], "y in m")
        self.assertEqual(labels[2:], [f"velocity along {axis} in m/s" for axis in "xyz"])


class Larger(Shown):
    """Scenes of several masses."""

    def test_outlines_stand_upright_in_gravity(self):
        for gravity, words in (([0, -9.81], ("x in m", "y in m")), ([-9.81, 0], None)):
            drawn = runs.Drawn("", "", 2, 1.0, gravity, 3, None)
            seen, said = picture.seen_from(drawn)
            self.assertEqual(said, words or ("across in m", "upwards in m"))
            np.testing.assert_allclose(seen(-np.array([*gravity, 0]) / 9.81), [0, 1], atol=1e-15)
        down = {"z": [0, 0, -1], "y": [0, -1, 0], "x": [-1, 0, 0], "up": [0, 0, 1]}
        for name, gravity in down.items():
            seen, _ = picture.seen_from(runs.Drawn("", "", 3, 1.0, gravity, 3, None))
            across, upwards = seen(-np.array(gravity, float))
            self.assertAlmostEqual(across, 0, delta=1e-12, msg=name)
            self.assertGreater(upwards, 0.8, name)
            # A view keeps the lengths across it: two directions of length 1, at right angles.
            view = seen(np.eye(3))
            np.testing.assert_allclose(view.T @ view, np.eye(2), atol=1e-12)

    def test_a_row_for_each_run_and_its_energy(self):
        nodes = [pin(0, 0), node(1, 0, mass=1), node(2, 0, mass=1)]
        links = [spring(0, 1, 100, rest_length=1.0), spring(1, 2, 100, rest_length=1.0)]
        path = self.folder / "links.toml"
        write(path, scene(nodes, links, gravity=[0, -9.81], until=0.5))
        page, axes = self.shown(f"--scene {path} --methods verlet,implicit_euler --step-size 0.01")
        self.assertEqual(len(axes), 3 * picture.TIMES + 1)
        # The last outline of each run shows where its page has the nodes at the end.
        for row, run in enumerate(page.data["motion"]["runs"]):
            outline = axes[(row + 1) * picture.TIMES - 1].collections[-1].get_segments()
            end = page.positions(run)[-1]
            size = page.data["motion"]["size"]
            np.testing.assert_allclose(outline[1], end[1:, :2], atol=size / 65535)
        self.assertEqual(page.data["motion"]["up"], [0, 1, 0])
        self.assertIsNone(page.data["answers"])
        self.assertNotIn("phase", page.data["motion"]["runs"][0])

    def test_a_broken_spring_is_gone_from_the_picture_and_from_the_page(self):
        for down in ([0, -1], [-1]):
            nodes = [pin(*(0 * d for d in down))]
            nodes += [node(*(i * d for d in down), mass=1) for i in (1, 2)]
            links = [spring(i, i + 1, 900, rest_length=1.0) for i in range(2)]
            links[1]["breaks_at"] = 0.018  # at about 0.11 s
            path = self.folder / "breaking.toml"
            gravity = [9.81 * d for d in down]
            write(path, scene(nodes, links, gravity=gravity, until=0.4))
            page, axes = self.shown(f"--scene {path} --methods verlet --step-size 0.01")
            for run in page.data["motion"]["runs"]:
                own = np.frombuffer(page.blobs[run["broken_from"]], "<u4").tolist()
                self.assertEqual(own[0], len(run["times"]))
                self.assertTrue(0.09 < run["times"][own[1] - 1] < run["times"][own[1]] < 0.13)
            # Outlines are at 0.1 s and later; on a line, the lowest node stands alone.
            outlines = [one.collections[-1].get_segments() for one in axes[: 2 * picture.TIMES]]
            whole, torn = ((2, 2), (2,)) if len(down) == 2 else ((3,), (1, 2))
            sizes = [tuple(map(len, lines)) for lines in outlines]
            self.assertEqual(sizes, 2 * [whole, torn, torn, torn])

    def test_a_run_that_blows_up_is_told(self):
        status, said, _ = self.show(
            "--scene cloth --methods explicit_euler --step-size 0.01 --until 0.5"
        )
        self.assertEqual(status, 0)
        self.assertRegex(said, "^motion: explicit_euler: .* of 0.5 s reached: ")
        data = Page(self.folder / "motion.html").data
        self.assertEqual(data["points"]["outcome"], ["diverged"])
        self.assertIn("of 0.5 s reached", data["points"]["cause"][0])


class Refused(Shown):
    """What cannot be shown."""

    def test_a_refusal_is_a_sentence_and_leaves_no_file(self):
        for words, *wanted in (
            ("--scene oscillator --step-size 0", "--step-size 0 is not allowed"),
            ("--scene oscillator --step-size x", "--step-size = x", "number"),
            ("--scene oscillator --step-size 0.1 --until -1", "--until"),
            ("--scene oscillator --step-size 0.1 --methods verlet,euler", "--methods: euler"),
            ("--scene oscillator --step-size 0.1 --methods cvode_bdf", "cvode_bdf", "--rtol"),
            ("--scene nothing --step-size 0.1", "nothing"),
            ("--scene oscillator", "--step-size"),
        ):
            status, said, _ = self.show(words)
            self.assertEqual(status, 2, words)
            for one in wanted:
                self.assertIn(one, said)
            self.assertEqual(os.listdir(self.folder), [])
