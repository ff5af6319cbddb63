#!/usr/bin/python3
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
from decoding import Page, elements
from packed_folder import Folder

HOSTILE = (
    "</script><script>alert(1)</script>",
    "<!-- <script> -->",
    "\"><img src=x onerror=alert(1)> ' & &amp; ]]>",
    "{{title}} <!-- qddot:data -->",
    "a\u2028b\u2029c\x00\x1b\x7f\r\n\tend",
    "\u202eright to left\u202c \u200f \u2066",
    "\ud800 half of a pair",
    "$x$ \\u003c \\",
)


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
        harmless = [tag for tag, _, _ in elements(self.named("cloth").text)]
        for name in HOSTILE:
            result = self.named(name)
            found = elements(result.text)
            self.assertEqual([tag for tag, _, _ in found], harmless, name)
            attributes = {key for _, attrs, _ in found for key in attrs}
            self.assertFalse(attributes - {"type", "id", "src", "alt"}, name)
            self.assertEqual(result.data["title"], name)
            self.assertEqual(result.data["methods"][0]["line"], name)

    def test_the_json_is_ascii_and_opens_no_element(self):
        for name in HOSTILE:
            text = self.named(name).json
            self.assertTrue(text.isascii() and text.isprintable(), name)
            self.assertNotIn("<", text)

    def test_titles_turn_no_direction(self):
        text = self.named(HOSTILE[5]).text
        self.assertNotRegex(text, "[\u200e\u200f\u202a-\u202e\u2066-\u2069]")


class Missing(Folder):
    """Files that are not there, or hold little."""

    def test_the_points_alone_make_a_page(self):
        made_folder.make_folder(self.folder, has_motions=False)
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

    def test_only_failures(self):
        made_folder.make_folder(self.folder, has_motions=False)
        rows = [row for row in self.rows() if row["outcome"] != "reached_end"]
        self.rewrite("points.csv", rows)
        data = self.page().data
        self.assertEqual({answer["why"] for answer in data["answers"]}, {"no method reached it"})
        self.assertIn("No run gave a point.", data["notes"])

    def test_one_point(self):
        made_folder.make_folder(self.folder, has_motions=False)
        rows = [row for row in self.rows() if row["outcome"] == "reached_end"]
        self.rewrite("points.csv", rows[:1])
        data = self.page().data
        self.assertEqual(len(data["methods"]), 1)
        reached = [answer for answer in data["answers"] if answer["point"] is not None]
        self.assertTrue(all(answer["next"] is None and not answer["others"] for answer in reached))

    def test_no_point_at_all(self):
        made_folder.make_folder(self.folder, has_motions=False)
        header = (self.folder / "points.csv").read_text().splitlines()[0]
        (self.folder / "points.csv").write_text(header + "\n")
        data = self.page().data
        self.assertEqual((data["methods"], data["points"]["method"]), ([], []))

    def test_an_interruption_is_said_first(self):
        made_folder.make_folder(self.folder, has_motions=False)
        self.edit("points.json", lambda content: content.update(interrupted="SIGINT"))
        self.assertRegex(self.page().data["notes"][0], "interrupted by SIGINT")

    def test_infinite_and_missing_numbers_are_null(self):
        made_folder.make_folder(self.folder, has_motions=False)
        rows = self.rows()
        rows[0] |= {"energy_growth": "inf", "setup_s": "nan", "steps": ""}
        self.rewrite("points.csv", rows)
        points = self.page().data["points"]
        for name in ("energy_growth", "setup_s", "steps"):
            self.assertIsNone(points[name][0])

    def test_a_number_that_is_not_finite_is_no_json(self):
        for number in (math.nan, math.inf):
            with self.assertRaises(ValueError):
                page.json_text({"x": number})

    def test_motions_that_were_not_kept_are_said(self):
        made_folder.make_folder(self.folder, side=3, frames=3, runs=1)
        self.edit("motions.json", lambda c: c.update(interrupted="SIGTERM", runs_left_out=7))
        notes = self.page().data["motion"]["notes"]
        self.assertRegex(" ".join(notes), "by SIGTERM.* for 7 more runs")

    def test_zero_motion(self):
        made_folder.make_folder(self.folder, side=3, frames=4, runs=1)
        for row in self.rows("motions.csv"):
            with h5py.File(self.folder / row["file"], "r+") as file:
                file["VTKHDF/Points"][...] = 1.5
        self.edit("motions.json", lambda content: content.update(displacement=0.0))
        self.edit("reference.json", lambda content: content["scales"].update(displacement=0.0))
        motion = self.page().data["motion"]
        self.assertIsNone(motion["distance_unit"])
        self.assertEqual({run["distances"] for run in motion["runs"]}, {None})
        self.assertTrue(motion["size"] > 0 and len(motion["pinned"]) == 9)

    def test_motions_without_a_reference(self):
        made_folder.make_folder(self.folder, side=3, frames=4, runs=3)
        self.rewrite("motions.csv", self.rows("motions.csv")[1:])
        runs = self.page().data["motion"]["runs"]
        self.assertEqual({run["role"] for run in runs}, {"run"})

    def test_without_a_reference_a_diverged_motion_does_not_make_the_box(self):
        made_folder.make_folder(self.folder, side=3, frames=40, runs=6)
        rows = self.rows("motions.csv")[1:]
        rows.sort(key=lambda row: row["outcome"] != "diverged")
        self.rewrite("motions.csv", rows)
        with h5py.File(self.folder / rows[0]["file"], "r+") as file:
            self.assertGreater(np.abs(file["VTKHDF/Points"]).max(), 100)
            # The second frame of the nine nodes is not far beyond what is believed.
            file["VTKHDF/Points"][9:18, 2] = 12
        motion = self.page().data["motion"]
        self.assertEqual(motion["runs"][0]["outcome"], "diverged")
        self.assertTrue(motion["runs"][0]["left_box"])
        # The sheet's side is 1 m, and its nodes move by less than that before they diverge.
        self.assertTrue(1 <= motion["size"] <= 3, motion["size"])

    def test_a_single_node_without_a_reference_moves_as_far_as_it_does(self):
        made_folder.make_folder(self.folder, side=1, frames=4, runs=1, dimension=1)
        (row,) = self.rows("motions.csv")[1:]
        self.rewrite("motions.csv", [row])
        with h5py.File(self.folder / row["file"], "r+") as file:
            file["VTKHDF/Points"][:, 0] = [0, 1, 2, 50][: len(file["VTKHDF/Points"])]
            far = float(file["VTKHDF/Points"][-1, 0])
        motion = self.page().data["motion"]
        self.assertEqual((motion["size"], motion["runs"][0]["left_box"]), (far, False))


class Broken(Folder):
    """Files that cannot be read."""

    def setUp(self):
        super().setUp()
        made_folder.make_folder(self.folder, side=3, frames=4, runs=3)
        self.motion = self.rows("motions.csv")[1]["file"]

    def spoiled_motion(self, change):
        """The page's data after a change to one motion's file."""
        with h5py.File(self.folder / self.motion, "r+") as file:
            change(file["VTKHDF"])
        return self.page().data

    def assert_not_shown(self, data, words=""):
        """A note names the motion and, if given, says these words of it; the others are shown, and
        the page does not tell where its folder was."""
        notes = data["motion"]["notes"]
        self.assertTrue(any(f"{self.motion} {words}" in note for note in notes), notes)
        self.assertEqual(len(data["motion"]["runs"]), 3)
        self.assertNotIn(str(self.folder), " ".join(notes))

    def test_a_motion_that_is_missing_or_no_motion_is_left_out(self):
        path = self.folder / self.motion
        whole = path.read_bytes()
        for content in (b"", b"no motion", whole[: len(whole) // 2]):
            path.write_bytes(content)
            self.assert_not_shown(self.page().data, "is no whole HDF5 file. It is not shown.")
        path.unlink()
        self.assert_not_shown(self.page().data, "is missing. It is not shown.")
        path.mkdir()
        self.assert_not_shown(self.page().data, "is no whole HDF5 file. It is not shown.")

    def test_a_motion_without_its_parts_is_left_out(self):
        def elsewhere(root):
            del root["Points"]
            root["Points"] = h5py.ExternalLink(self.folder / "nowhere.h5", "/Points")

        for change in (elsewhere, lambda root: root.pop("Points", None)):
            data = self.spoiled_motion(change)
            self.assert_not_shown(data, "does not hold a motion. It is not shown.")

    def test_a_damaged_frame_is_told_without_the_words_of_hdf5(self):
        path = self.folder / self.motion
        with h5py.File(path, "r") as file:
            start = file["VTKHDF/Points"].id.get_chunk_info(0)
        content = bytearray(path.read_bytes())
        content[start.byte_offset : start.byte_offset + start.size] = b"\xff" * start.size
        path.write_bytes(content)
        notes = self.page().data["notes"]
        words = f"The motions cannot be shown: {self.motion} is no whole HDF5 file."
        self.assertEqual(notes, [words])

    def test_a_motion_whose_parts_do_not_fit_is_left_out(self):
        def shorter(root):
            points = root["Points"][:-1]
            del root["Points"]
            root["Points"] = points

        self.assert_not_shown(self.spoiled_motion(shorter))

    def test_springs_of_no_nodes_are_refused(self):
        def far(root):
            root["Lines/Connectivity"][0] = 99

        self.assert_not_shown(self.spoiled_motion(far))

    def test_positions_that_are_no_numbers_leave_the_box(self):
        def spoil(root):
            root["Points"][-1] = [math.nan, math.inf, -math.inf]

        data = self.spoiled_motion(spoil)
        self.assertTrue(data["motion"]["runs"][1]["left_box"])
        self.assertTrue(np.isfinite([data["motion"]["size"], *data["motion"]["low"]]).all())

    def test_a_motion_outside_the_folder_is_not_read(self):
        rows = self.rows("motions.csv")
        shutil.copy(self.folder / self.motion, self.folder.parent / "other.vtkhdf")
        rows[1]["file"] = self.motion = "../other.vtkhdf"
        self.rewrite("motions.csv", rows)
        self.assert_not_shown(self.page().data)

    def test_motions_of_another_study_are_not_shown(self):
        for other in ({"until": 0.25}, {"scene": {"hash": "another"}}):
            self.edit("motions.json", lambda content, other=other: content.update(other))
            data = self.page().data
            self.assertIsNone(data["motion"])
            self.assertRegex(data["notes"][0], "are of another study")

    def test_motions_of_other_options_are_of_another_study(self):
        def told(**options):
            return {"options": {name.replace("_", "-"): value for name, value in options.items()}}

        own = told(__solver=["cholmod"], __methods=["verlet"], __repeats=["3"])
        self.edit("points.json", lambda content: content.update(study=own))
        for study, is_shown in (
            (told(__solver=["cholmod"], __point_limit=["2"]), True),
            (told(__solver=["klu", "cholmod"]), True),
            (told(__solver=["klu"], __methods=["verlet"]), False),
            (told(), False),
            ({}, True),
        ):
            self.edit("motions.json", lambda content, s=study: content.update(study=s))
            data = self.page().data
            self.assertEqual(data["motion"] is not None, is_shown, study)
            if not is_shown:
                self.assertRegex(data["notes"][0], "are of another study")

    def test_a_broken_table_of_motions_is_a_note(self):
        (self.folder / "motions.csv").write_text("file,role\n")
        data = self.page().data
        self.assertIsNone(data["motion"])
        self.assertRegex(data["notes"][0], ": motions.csv has no column method")

    def test_broken_energies_are_a_note(self):
        (self.folder / "motions_energy.csv").write_text("file,t,kinetic,potential,total\na,b,,,\n")
        data = self.page().data
        self.assertIsNone(data["motion"]["runs"][0]["energy"])
        self.assertRegex(data["motion"]["notes"][0], "^motions_energy.csv.* t is 'b', not a number")

    def test_a_broken_picture_is_a_note(self):
        (self.folder / "modes.png").write_bytes(b"\x89PNG\r\n\x1a\nnothing")
        data = self.page().data
        self.assertEqual(data["pictures"], [])
        self.assertEqual(data["notes"], ["modes.png is no picture that can be read."])

    def test_odd_sidecars_say_nothing(self):
        for text in (
            "",
            "[]",
            '{"reduced": 3, "methods": [1], "study": [], "scene": "x"}',
            "[" * 9999,
        ):
            (self.folder / "points.json").write_text(text)
            self.assertEqual(self.packed().data["command"], [])

    def test_broken_points_are_refused_in_one_sentence(self):
        before = (self.folder / "report.html").exists()
        text = (self.folder / "points.csv").read_text()
        for broken in (text.replace("0.02,", "tiny,", 1), "a,b\n1,2\n", "\x00\xff"):
            (self.folder / "points.csv").write_text(broken, encoding="latin-1")
            status, said = self.call()
            self.assertEqual(status, 2)
            self.assertRegex(said, r"^.*points\.csv.*\.\n$")
        (self.folder / "points.csv").unlink()
        self.assertEqual(self.call()[0], 2)
        self.assertEqual((self.folder / "report.html").exists(), before)

    def test_the_page_before_stays_where_a_new_one_cannot_be_written(self):
        before = self.page().text
        with mock.patch("os.replace", side_effect=OSError(28, "No space left on device")):
            status, said = self.call()
        self.assertEqual((status, said.count("\n")), (2, 1))
        self.assertIn("No space left", said)
        self.assertEqual(Page(self.folder / "report.html").text, before)
        self.assertEqual([file for file in self.folder.iterdir() if "html." in file.name], [])

    def test_two_packers_of_a_folder_do_not_write_into_each_other(self):
        path = str(self.folder / "report.html")
        replace, others = os.replace, ["another"]

        def replace_late(source, target):
            # Another packer writes all of its page between this one's writing and renaming.
            if others:
                report.write_whole(path, others.pop())
            # Another folder may be on another disk: files there cannot be renamed in one call.
            self.assertTrue(Path(source).is_relative_to(self.folder))
            replace(source, target)

        with mock.patch("os.replace", replace_late):
            report.write_whole(path, "mine")
        self.assertEqual((self.folder / "report.html").read_text(), "mine")

    def test_the_page_has_the_rights_of_any_new_file(self):
        self.page()
        (self.folder / "new").touch()
        rights = [(self.folder / name).stat().st_mode for name in ("report.html", "new")]
        self.assertEqual(*rights)

    def test_a_wrong_call_is_refused(self):
        for arguments in ([], ["a", "b"], ["--help"]):
            with mock.patch("sys.stderr"):
                self.assertEqual(report.main(arguments), 2)


if __name__ == "__main__":
    unittest.main()
