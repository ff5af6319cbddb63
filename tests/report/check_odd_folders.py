"""Whether the page of a folder with hostile names, missing or broken files is harmless and honest,
and whether it appears whole or not at all."""

import math
import os
import shutil
import unittest
from pathlib import Path
from unittest import mock

import h5py
import numpy as np

import made_folder
import made_sweeps
import page
import report
from packed_folder import Folder, Page, elements, pack

HOSTILE = (
    "</script><script>alert(1)</script>", "<!-- <script> -->",
    "\"><img src=x onerror=alert(1)> ' & &amp; ]]>", "{{title}} <!-- qddot:data -->",
    "a\u2028b\u2029c\x00\x1b\x7f\r\n\tend", "\u202eright to left\u202c \u200f \u2066",
    "\ud800 half of a pair", "$x$ \\u003c \\",
)  # fmt: skip


class Names(Folder):
    """Names and texts that are more than names."""

    def named(self, name):
        """The page of a scene of this name."""
        made_folder.make_folder(self.folder, side=3, frames=3, runs=1)
        self.edit("chart.json", lambda content: content.update(scene=name))

        def change(content):
            content["scene"]["name"] = content["cpu"] = content["command_line"][2] = name
            content["methods"][0]["summary"] = content["outcomes"]["diverged"] = name
            content["reduced"]["reductions"][0]["what"] = name

        self.edit("points.json", change)
        rows = self.rows("motions.csv")
        rows[1]["why"] = name.encode("utf-8", "replace").decode().replace("\x00", "")
        self.rewrite("motions.csv", rows)
        return self.packed()

    def test_hostile_names_are_text(self):
        harmless = [(tag, list(attrs)) for tag, attrs, _ in elements(self.named("cloth").text)]
        for name in HOSTILE:
            result = self.named(name)
            found = [(tag, list(attrs)) for tag, attrs, _ in elements(result.text)]
            self.assertEqual(found, harmless, name)
            self.assertEqual(result.data["title"], name)
            self.assertEqual(result.data["methods"][0]["line"], name)
            # The JSON is ASCII and opens no element, and titles turn no direction.
            self.assertTrue(result.json.isascii() and result.json.isprintable(), name)
            self.assertNotIn("<", result.json)
            self.assertNotRegex(result.text, "[\u200e\u200f\u202a-\u202e\u2066-\u2069]")


class Points(Folder):
    """Points of which files are missing, hold little or are broken."""

    def setUp(self):
        super().setUp()
        made_folder.make_folder(self.folder, has_motions=False)

    def test_the_points_alone_make_a_page(self):
        for name in ("front.csv", "front.json", "points.json", "reference.json"):
            (self.folder / name).unlink()
        data = self.page().data
        self.assertIsNone(data["motion"])
        self.assertEqual((data["until"], data["command"]), (None, []))
        self.assertEqual((data["left_out"], data["reference"]), (None, []))
        self.assertEqual(set(data["points"]["command"]), {None})
        # The bounds of the errors in the table tell it.
        self.assertAlmostEqual(data["quantities"][0]["floor"], made_sweeps.CERTIFIED, delta=1e-15)
        self.assertIsNotNone(data["answers"][0]["point"])
        self.assertRegex(" ".join(data["notes"]), "no reference.json.* no points.json")

    def test_few_points_and_missing_numbers(self):
        rows = self.rows()
        good = [row for row in rows if row["outcome"] == "reached_end"]
        self.edit("points.json", lambda content: content.update(interrupted="SIGINT"))
        data = self.data_of([row for row in rows if row not in good])
        self.assertEqual({answer["why"] for answer in data["answers"]}, {"no method reached it"})
        self.assertIn("No run gave a point.", data["notes"])
        self.assertRegex(data["notes"][0], "interrupted by SIGINT")
        # Infinite and missing numbers are null.
        good[0] |= {"energy_growth": "inf", "setup_s": "nan", "steps": ""}
        data = self.data_of(good[:1])
        for name in ("energy_growth", "setup_s", "steps"):
            self.assertIsNone(data["points"][name][0])
        self.assertEqual(len(data["methods"]), 1)
        reached = [answer for answer in data["answers"] if answer["point"] is not None]
        self.assertTrue(all(answer["next"] is None and not answer["others"] for answer in reached))
        for number in (math.nan, math.inf):
            with self.assertRaises(ValueError):
                page.json_text({"x": number})
        header = (self.folder / "points.csv").read_text().splitlines()[0]
        (self.folder / "points.csv").write_text(header + "\n")
        data = self.page().data
        self.assertEqual((data["methods"], data["points"]["method"]), ([], []))

    def test_odd_sidecars_say_nothing(self):
        odd = '{"reduced": 3, "methods": [1], "study": [], "scene": "x"}'
        for text in ("", "[]", odd, "[" * 9999):
            (self.folder / "points.json").write_text(text)
            self.assertEqual(self.packed().data["command"], [])
        for odd in ('{"command_line": 5}', '{"libraries": 5}', '{"study": {"options": 5}}'):
            (self.folder / "points.json").write_text(odd)
            status, said = pack(self.folder)
            self.assertEqual((status, said.count("\n")), (2, 1))

    def test_a_broken_picture_is_a_note(self):
        (self.folder / "modes.png").write_bytes(b"\x89PNG\r\n\x1a\nnothing")
        data = self.page().data
        self.assertEqual(data["pictures"], [])
        self.assertEqual(data["notes"], ["modes.png is no picture that can be read."])

    def test_broken_points_are_refused_in_one_sentence(self):
        text = (self.folder / "points.csv").read_text()
        for broken in (text.replace("0.02,", "tiny,", 1), "a,b\n1,2\n", "\x00\xff"):
            (self.folder / "points.csv").write_text(broken, encoding="latin-1")
            status, said = pack(self.folder)
            self.assertEqual(status, 2)
            self.assertRegex(said, r"^.*points\.csv.*\.\n$")
        (self.folder / "points.csv").unlink()
        self.assertEqual(pack(self.folder)[0], 2)
        self.assertFalse((self.folder / "report.html").exists())
        for arguments in ([], ["a", "b"], ["--help"]):
            with mock.patch("sys.stderr"):
                self.assertEqual(report.main(arguments), 2)

    def test_the_page_appears_whole_or_not_at_all(self):
        before, path = self.page().text, self.folder / "report.html"
        with mock.patch("os.replace", side_effect=OSError(28, "No space left on device")):
            status, said = pack(self.folder)
        self.assertEqual((status, said.count("\n")), (2, 1))
        self.assertIn("No space left", said)
        self.assertEqual(Page(path).text, before)
        self.assertEqual([file for file in self.folder.iterdir() if "html." in file.name], [])
        replace, others = os.replace, ["another"]

        def replace_late(source, target):
            # Another packer writes all of its page between this one's writing and renaming.
            if others:
                report.write_whole(str(path), others.pop())
            # Another folder may be on another disk: files there cannot be renamed in one call.
            self.assertTrue(Path(source).is_relative_to(self.folder))
            replace(source, target)

        with mock.patch("os.replace", replace_late):
            report.write_whole(str(path), "mine")
        self.assertEqual(path.read_text(), "mine")
        # It has the rights of any new file.
        (self.folder / "new").touch()
        self.assertEqual(path.stat().st_mode, (self.folder / "new").stat().st_mode)


class Motions(Folder):
    """Motions that are odd, missing or broken."""

    def setUp(self):
        super().setUp()
        made_folder.make_folder(self.folder, side=3, frames=40, runs=6)
        self.table = self.rows("motions.csv")
        self.motion = self.table[1]["file"]

    def shown(self):
        """The motion in the page."""
        return self.page().data["motion"]

    def opened(self, row):
        """The file of a row of the table, to be changed."""
        return h5py.File(self.folder / row["file"], "r+")

    def test_motions_that_were_not_kept_are_said(self):
        self.edit("motions.json", lambda c: c.update(interrupted="SIGTERM", runs_left_out=7))
        self.assertRegex(" ".join(self.shown()["notes"]), "by SIGTERM.* for 7 more runs")

    def test_zero_motion(self):
        for row in self.table:
            with self.opened(row) as file:
                file["VTKHDF/Points"][...] = 1.5
        self.edit("motions.json", lambda content: content.update(displacement=0.0))
        self.edit("reference.json", lambda content: content["scales"].update(displacement=0.0))
        motion = self.shown()
        self.assertIsNone(motion["distance_unit"])
        self.assertEqual({run["distances"] for run in motion["runs"]}, {None})
        self.assertTrue(motion["size"] > 0 and len(motion["pinned"]) == 9)

    def test_without_a_reference_a_diverged_motion_does_not_make_the_box(self):
        rows = sorted(self.table[1:], key=lambda row: row["outcome"] != "diverged")
        self.rewrite("motions.csv", rows)
        with self.opened(rows[0]) as file:
            self.assertGreater(np.abs(file["VTKHDF/Points"]).max(), 100)
            # The second frame of the nine nodes is not far beyond what is believed.
            file["VTKHDF/Points"][9:18, 2] = 12
        motion = self.shown()
        self.assertEqual({run["role"] for run in motion["runs"]}, {"run"})
        self.assertEqual(motion["runs"][0]["outcome"], "diverged")
        self.assertTrue(motion["runs"][0]["left_box"])
        # The sheet's side is 1 m, and its nodes move by less than that before they diverge.
        self.assertTrue(1 <= motion["size"] <= 3, motion["size"])
        # A single node moves as far as it does.
        made_folder.make_folder(self.folder, side=1, frames=4, runs=1, dimension=1)
        (row,) = self.rows("motions.csv")[1:]
        self.rewrite("motions.csv", [row])
        with self.opened(row) as file:
            file["VTKHDF/Points"][:, 0] = [0, 1, 2, 50][: len(file["VTKHDF/Points"])]
            far = float(file["VTKHDF/Points"][-1, 0])
        motion = self.shown()
        self.assertEqual((motion["size"], motion["runs"][0]["left_box"]), (far, False))

    def assert_not_shown(self, words=""):
        """A note names the motion and, if given, says these words of it; the others are shown, and
        the page does not tell where its folder was."""
        motion = self.shown()
        notes = motion["notes"]
        self.assertTrue(any(f"{self.motion} {words}" in note for note in notes), notes)
        self.assertEqual(len(motion["runs"]), 6)
        self.assertNotIn(str(self.folder), " ".join(notes))

    def test_a_motion_that_is_missing_or_no_motion_is_left_out(self):
        path = self.folder / self.motion
        whole = path.read_bytes()
        for content in (b"", b"no motion", whole[: len(whole) // 2]):
            path.write_bytes(content)
            self.assert_not_shown("is no whole HDF5 file. It is not shown.")
        path.unlink()
        self.assert_not_shown("is missing. It is not shown.")
        path.mkdir()
        self.assert_not_shown("is no whole HDF5 file. It is not shown.")

    def test_a_motion_of_broken_parts_is_left_out(self):
        def without(root):
            del root["Points"]

        def elsewhere(root):
            del root["Points"]
            root["Points"] = h5py.ExternalLink(self.folder / "nowhere.h5", "/Points")

        def shorter(root):
            points = root["Points"][:-1]
            del root["Points"]
            root["Points"] = points

        def far(root):
            root["Lines/Connectivity"][0] = 99

        def strained(root):
            root["CellData/strain"] = np.zeros(7, "f4")

        path = self.folder / self.motion
        whole, lacks = path.read_bytes(), "does not hold a motion. It is not shown."
        unlike = "cannot be read: its strain does not fit its springs. It is not shown."
        changes = ((without, lacks), (elsewhere, lacks), (shorter, ""), (far, ""), (strained, unlike))
        for change, words in changes:
            path.write_bytes(whole)
            with self.opened(self.table[1]) as file:
                change(file["VTKHDF"])
            self.assert_not_shown(words)
        # Nor is one outside the folder.
        path.write_bytes(whole)
        shutil.copy(path, self.folder.parent / "other.vtkhdf")
        self.table[1]["file"] = self.motion = "../other.vtkhdf"
        self.rewrite("motions.csv", self.table)
        self.assert_not_shown()

    def test_a_damaged_frame_is_told_without_the_words_of_hdf5(self):
        path = self.folder / self.motion
        with h5py.File(path, "r") as file:
            start = file["VTKHDF/Points"].id.get_chunk_info(0)
        content = bytearray(path.read_bytes())
        content[start.byte_offset : start.byte_offset + start.size] = b"\xff" * start.size
        path.write_bytes(content)
        words = f"The motions cannot be shown: {self.motion} is no whole HDF5 file."
        self.assertEqual(self.page().data["notes"], [words])

    def test_positions_that_are_no_numbers_leave_the_box(self):
        with self.opened(self.table[1]) as file:
            file["VTKHDF/Points"][-1] = [math.nan, math.inf, -math.inf]
        motion = self.shown()
        self.assertTrue(motion["runs"][1]["left_box"])
        self.assertTrue(np.isfinite([motion["size"], *motion["low"]]).all())

    def test_motions_of_another_study_are_not_shown(self):
        def told(**options):
            names = {name.replace("_", "-"): value for name, value in options.items()}
            return {"study": {"options": names}}

        own = told(__solver=["cholmod"], __methods=["verlet"], __repeats=["3"])
        self.edit("points.json", lambda content: content.update(own))
        before = (self.folder / "motions.json").read_text()
        for other, is_shown in (
            (told(__solver=["cholmod"], __point_limit=["2"]), True),
            (told(__solver=["klu", "cholmod"]), True), ({"study": {}}, True),
            (told(__solver=["klu"], __methods=["verlet"]), False), (told(), False),
            ({"until": 0.25}, False), ({"scene": {"hash": "another"}}, False),
        ):  # fmt: skip
            (self.folder / "motions.json").write_text(before)
            self.edit("motions.json", lambda content, other=other: content.update(other))
            data = self.page().data
            self.assertEqual(data["motion"] is not None, is_shown, other)
            if not is_shown:
                self.assertRegex(data["notes"][0], "are of another study")

    def test_broken_tables_are_notes(self):
        (self.folder / "motions_energy.csv").write_text("file,t,kinetic,potential,total\na,b,,,\n")
        motion = self.shown()
        self.assertIsNone(motion["runs"][0]["energy"])
        self.assertRegex(motion["notes"][0], "^motions_energy.csv.* t is 'b', not a number")
        (self.folder / "motions.csv").write_text("file,role\n")
        data = self.page().data
        self.assertIsNone(data["motion"])
        self.assertRegex(data["notes"][0], ": motions.csv has no column method")
