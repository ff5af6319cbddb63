#!/usr/bin/python3
"""Whether a folder becomes one page that holds what the files say, and nothing else: made folders,
hostile names, missing and broken files."""

import math
import os
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
from PIL import Image

import emphasis
import made_folder
import motion_files
import page
import report
import static_part
from decoding import Page, elements
from packed_folder import Folder
from record import read_record

SLOW = (
    "symplectic_euler semi_implicit_euler position_verlet blanes_moan4 blanes_moan6 symmetric6"
    " symmetric10 dprkn6 dprkn8"
).split()


class Contents(Folder):
    """What is in the page of a whole folder."""

    def test_every_number_of_the_points_comes_through(self):
        data = self.make().data
        points = data["points"]
        rows = self.rows()
        self.assertEqual(len(points["method"]), len(rows))
        for column in ("value", "t_reached", "error_position", "time_s", "energy_growth", "steps"):
            expected = [float(row[column]) if row[column] else None for row in rows]
            self.assertEqual(points[column], expected, column)
        names = [data["methods"][index]["name"] for index in points["method"]]
        self.assertEqual(names, [row["method"] for row in rows])
        for column in ("knob", "outcome"):
            self.assertEqual(points[column], [row[column] for row in rows])
        self.assertTrue(all(len(column) == len(rows) for column in points.values()))
        self.assertTrue(set(data["counts"]) <= set(points))

    def test_each_failure_has_its_sentence(self):
        points = self.make().data["points"]
        for outcome, error, cause in zip(
            points["outcome"], points["error_position"], points["cause"]
        ):
            if outcome == "reached_end":
                self.assertEqual(cause, "error above 3" if error > 3 else None)
            else:
                self.assertRegex(cause, "^the [a-z]+")
        self.assertIn("the motion grew without bound", " ".join(filter(None, points["cause"])))

    def test_a_study_without_sentences_has_the_outcomes_own_words(self):
        made_folder.make_folder(self.folder, has_motions=False)
        self.edit("points.json", lambda content: content.pop("outcomes"))
        causes = self.page().data["points"]["cause"]
        self.assertIn("Newton failed", causes)

    def test_methods_have_the_looks_of_the_pictures(self):
        data = self.make().data
        methods = {method["name"]: method for method in data["methods"]}
        titles = {name: data["families"][m["family"]]["title"] for name, m in methods.items()}
        self.assertEqual((titles["verlet"], titles["ida"]), ("hand-written", "SUNDIALS"))
        self.assertEqual(methods["ida_klu"]["color"], methods["ida"]["color"])
        self.assertEqual(methods["symmetric8"]["line"], "eight, <b>bold</b>")
        self.assertLessEqual(sum(method["strong"] for method in data["methods"]), 12)
        self.assertTrue(methods["symmetric4"]["strong"])

    def test_colours_are_those_of_the_picture_of_the_folder(self):
        made_folder.make_folder(self.folder, has_motions=False)
        rows = self.rows()
        # So many slow methods before the others that some stay pale and take the last colours.
        slow = [row for row in rows if row["method"] == "explicit_euler"]
        slow = [row | {"method": name} for name in SLOW for row in slow]
        self.rewrite("points.csv", slow + rows)
        methods = self.page().data["methods"]
        self.assertEqual({method["strong"] for method in methods}, {True, False})
        looks = emphasis.Prominent([read_record(self.folder).judged]).looks
        self.assertEqual(len(methods), len(looks))
        for method in methods:
            look = looks[method["name"]]
            self.assertEqual((method["color"], method["marker"]), (look.color, look.marker))

    def test_the_page_is_one_file_with_all_its_parts(self):
        text = self.make().text
        found = elements(text)
        self.assertIn(["script", {}, page.packed_script("page/a.js")], found)
        self.assertIn(["style", {}, "p { color: red; }"], found)
        self.assertNotRegex(text, r"<!-- qddot:(style|scripts|static) -->|\{\{")
        cells = [text for tag, _, text in found if tag == "td"]
        self.assertIn("symmetric4", cells)

    def test_the_same_folder_gives_the_same_bytes(self):
        first = self.make().text
        self.assertEqual(first, self.page().text)

    def test_the_commands_repeat_the_study_and_its_runs(self):
        made_folder.make_folder(self.folder, has_motions=False)

        def change(content):
            content["command_line"][2] = "my scenes/it's.toml"
            content["study"]["options"] = {
                "--methods": ["verlet", "ida"],
                "--solver": ["cholmod"],
                "--point-limit": ["0.5", "2"],
                "--stability-detection": ["true"],
                "--no-reduce": ["mirror", "pins"],
            }
            for note in content["methods"]:
                note["takes"] = ["--solver"] if note["name"] == "ida" else []

        self.edit("points.json", change)
        data = self.page().data
        scene = "'my scenes/it'\"'\"'s.toml'"
        self.assertEqual(
            data["command"],
            [
                f"./run report {scene} --methods verlet,ida --solver cholmod --point-limit 2"
                " --stability-detection --no-reduce mirror,pins"
            ],
        )
        names = [data["methods"][index]["name"] for index in data["points"]["method"]]
        commands = dict(zip(names, data["points"]["command"]))
        simulate = f"build/bin/simulate --scene {scene} --method"
        self.assertRegex(
            commands["verlet"],
            f"{simulate} verlet --step-size [0-9.e-]+ --until 0.5 --no-reduce mirror,pins$",
        )
        self.assertRegex(
            commands["ida"],
            f"{simulate} ida --rtol 1e-11 --until 0.5 --no-reduce mirror,pins --solver cholmod$",
        )


class Motions(Folder):
    """The motions in the page."""

    def test_positions_are_those_of_the_files(self):
        result = self.make(runs=4)
        motion = result.data["motion"]
        self.assertEqual(motion["nodes"], 144)
        self.assertEqual([run["role"] for run in motion["runs"]], ["reference"] + 4 * ["run"])
        for run, row in zip(motion["runs"], self.rows("motions.csv")):
            with h5py.File(self.folder / row["file"]) as file:
                points = np.array(file["VTKHDF/Points"]).reshape(len(run["times"]), -1, 3)
            positions = result.positions(run)
            inside = (points >= motion["low"]) & (
                points <= motion["size"] + np.array(motion["low"])
            )
            self.assertEqual(run["left_box"], not inside.all())
            # Half a step, and the roundings of positions of about 1 m.
            error = np.abs(positions - points)[inside].max()
            self.assertLessEqual(error, motion["size"] / 65535 / 2 + 1e-14)
            if row["outcome"] == "reached_end":
                self.assertFalse(run["left_box"])

    def test_distances_are_relative_to_the_largest_displacement(self):
        result = self.make(runs=3)
        motion = result.data["motion"]
        self.assertIsNone(motion["runs"][0]["distances"])
        for run, row in zip(motion["runs"][1:], self.rows("motions.csv")[1:]):
            if row["outcome"] != "reached_end":
                continue
            largest = result.distances(run).max()
            # A code stands for decades within half of 14 / 254.
            ratio = math.log10(largest / min(1.0, float(row["largest_distance"])))
            self.assertLessEqual(abs(ratio), 14 / 254 / 2 + 1e-6)

    def test_each_run_knows_its_point(self):
        data = self.make().data
        for run, row in zip(data["motion"]["runs"], self.rows("motions.csv")):
            point = run["point"]
            self.assertEqual(
                data["methods"][data["points"]["method"][point]]["name"], row["method"]
            )
            self.assertEqual(data["points"]["value"][point], float(row["value"]))
            self.assertEqual(len(run["energy"]["t"]), int(row["frames"]))

    def test_energies_have_the_digits_that_are_shown(self):
        made_folder.make_folder(self.folder, has_motions=False)
        (self.folder / "motions_energy.csv").write_text(
            "file,t,kinetic,potential,total\na,0.012345678901,2.3456789012e-5,-1.2345678901,"
            "0.12345678901234567\na,0.5,nan,,inf\n"
        )
        found = motion_files.read_energies(self.folder)["a"]
        self.assertEqual(found["t"], [0.01234568, 0.5])
        self.assertEqual(found["kinetic"], [2.345679e-5, None])
        self.assertEqual(found["potential"], [-1.234568, None])
        self.assertEqual(found["total"], [0.12345678901234567, None])

    def test_nodes_that_never_move_are_pinned(self):
        motion = self.make(side=5).data["motion"]
        self.assertEqual(motion["pinned"], [0, 5, 10, 15, 20])

    def test_topology_is_the_scenes(self):
        result = self.make(side=3)
        springs = np.frombuffer(result.blobs["s0"], "<u4").reshape(-1, 2)
        faces = np.frombuffer(result.blobs["f0"], "<u4").reshape(-1, 3)
        self.assertEqual((springs[0].tolist(), len(springs)), ([0, 1], 12))
        self.assertEqual((faces[0].tolist(), len(faces)), ([0, 1, 3], 8))

    def test_scenes_of_fewer_dimensions_and_parts(self):
        for dimension in (1, 2):
            motion = self.make(dimension=dimension, runs=2).data["motion"]
            self.assertEqual((motion["dimension"], motion["faces"]), (dimension, None))
        result = self.make(has_springs=False, has_faces=False, runs=2)
        self.assertEqual(result.blobs["s0"], b"")
        self.assertIsNone(result.data["motion"]["faces"])

    def test_one_node_in_one_frame(self):
        motion = self.make(side=1, frames=1, runs=0, dimension=1).data["motion"]
        self.assertEqual((motion["nodes"], motion["pinned"]), (1, []))
        self.assertGreater(motion["size"], 0)

    def test_ten_thousand_nodes_stay_below_eight_megabytes(self):
        data = self.make(side=100, frames=60, runs=20, noise=1e-3).data
        size = os.path.getsize(self.folder / "report.html")
        self.assertLessEqual(size, 8_000_000)
        runs = data["motion"]["runs"]
        self.assertEqual(runs[0]["role"], "reference")
        self.assertEqual((runs[0]["times"][0], runs[0]["times"][-1]), (0, 0.5))
        kept = [run["label"] for run in runs]
        self.assertTrue(1 < len(kept) < 21)
        self.assertRegex(
            " ".join(data["motion"]["notes"]), r"holds \d+ of the 21 motions .* files in motions/"
        )

    def test_a_run_of_seconds_by_phase(self):
        made_folder.make_folder(self.folder, runs=1)
        rows = self.rows("motions.csv")
        names = [
            "seconds",
            *(f"seconds_{p}" for p in ("force", "stiffness", "factorization", "solve")),
        ]
        rows[0] |= dict.fromkeys(names, "")
        rows[1] |= dict(zip(names, ("2", "0.5", "", "0.25", "0")))
        self.rewrite("motions.csv", rows)
        first, second = self.page().data["motion"]["runs"]
        self.assertIsNone(first["seconds"])
        self.assertEqual(
            second["seconds"],
            {"all": 2, "force": 0.5, "stiffness": None, "factorization": 0.25, "solve": 0},
        )


class BeyondTheHorizon(Folder):
    """A folder whose end is beyond the horizon of a chaotic motion."""

    def setUp(self):
        super().setUp()
        made_folder.make_folder(self.folder, has_motions=False)
        known = {"beyond_horizon": True, "horizon": 0.3, "lyapunov": 50.0, "chaotic": True}
        self.edit("reference.json", lambda content: content.update(known))

    def test_energy_judges(self):
        data = self.page().data
        self.assertEqual(data["judged_by"], "energy")
        self.assertEqual(data["quantities"][0]["column"], "error_energy_max")
        self.assertRegex(data["notes"][0], "^Chaotic: from t = 0.3 s on")
        self.assertNotIn("\n", data["notes"][0])

    def test_a_position_error_is_no_failure(self):
        self.edit("reference.json", lambda content: content.update(modal_shares_floor=0.01))
        rows = [row for row in self.rows() if row["outcome"] == "reached_end"]
        for row in rows:
            row |= {"error_position": 9, "error_position_at_least": 9, "error_position_at_most": 9}
        for row, error in zip(rows, (1e-5, 4, "")):
            row |= {"error_energy_max": error, "error_modal_shares": 0.01}
        self.rewrite("points.csv", rows)
        data = self.page().data
        expected = [None, "error above 3", "error not measured"]
        self.assertEqual(data["points"]["cause"][:3], expected)
        self.assertIsNotNone(data["answers"][0]["point"])
        self.assertNotIn("No run gave a point.", data["notes"])
        for row in rows:
            row |= {"error_position": 1e-3, "error_energy_max": 4}
        self.rewrite("points.csv", rows)
        self.assertIn("No run gave a point.", self.page().data["notes"])

    def test_another_motion_is_no_answer(self):
        self.edit("reference.json", lambda content: content.update(modal_shares_floor=0.01))
        rows = self.rows()
        for row in rows:
            # Chance makes 0.01; ten times as far is another motion.
            row["error_modal_shares"] = 0.11 if row["method"] == "symmetric8" else 0.09
        self.rewrite("points.csv", rows)
        data = self.page().data
        names = [data["methods"][index]["name"] for index in data["points"]["method"]]
        fastest = {names[answer["point"]] for answer in data["answers"] if answer["point"]}
        self.assertTrue(fastest)
        self.assertNotIn("symmetric8", fastest)
        counts = data["quantities"][0]["counts"]
        self.assertEqual(counts, [name != "symmetric8" for name in names])


class WithoutScripts(Folder):
    """What a reader sees where no scripts run."""

    def elements(self, tag):
        """The attributes and texts of the page's elements of a kind."""
        return [(found[1], found[2]) for found in elements(self.page().text) if found[0] == tag]

    def test_the_answers_are_spelled_as_in_the_page(self):
        made_folder.make_folder(self.folder, has_motions=False)
        data = self.page().data
        columns = len(self.elements("th"))
        cells = [text for _, text in self.elements("td")]
        rows = [cells[start : start + columns] for start in range(0, len(cells), columns)]
        self.assertEqual([row[0] for row in rows], [f"1e-{digit}" for digit in range(2, 9)])
        for row, answer in zip(rows, data["answers"]):
            value = data["points"]["value"][answer["point"]]
            self.assertEqual(float(row[2].split()[2]), float(f"{value:.4g}"))
            self.assertEqual(row[-1], answer["warning"] or "")
        self.assertRegex(
            " ".join(row[-1] for row in rows), "% (below|above) its limit of stability"
        )
        texts = [text for _, text in self.elements("p")]
        self.assertEqual(texts.count(data["answers_note"]), 1)

    def test_without_a_margin_there_is_no_note_on_margins(self):
        made_folder.make_folder(self.folder, has_motions=False)
        (self.folder / "front.csv").unlink()
        self.assertIsNone(self.page().data["answers_note"])
        self.assertNotIn("limit of stability", self.page().text)

    def test_as_long_is_not_once_as_long(self):
        for ratio, words in (
            (1.0, "just as long"),
            (1.004, "just as long"),
            (1.04, "1.04 × as long"),
        ):
            self.assertEqual(static_part.how_long(ratio), words)

    def test_the_chart_is_no_wider_than_the_page(self):
        made_folder.make_folder(self.folder, has_motions=False)
        Image.new("RGB", (2000, 10), "white").save(self.folder / "chart.png")
        ((attributes, _),) = self.elements("img")
        self.assertEqual(attributes["style"], "max-width:100%")


class RealPage(unittest.TestCase):
    """The page that is shipped, with its own template, styles and scripts."""

    def test_it_holds_its_styles_and_scripts(self):
        with tempfile.TemporaryDirectory() as folder:
            made_folder.make_folder(folder, side=3, frames=3, runs=1, scene="a </title> b")
            self.assertEqual(report.main([folder]), 0)
            result = Page(Path(folder) / "report.html")
        found = elements(result.text)
        texts = [text for _, _, text in found]
        for text in [*page.scripts(), *map(page.read_source, page.STYLES)]:
            self.assertIn(text, texts)
        self.assertNotRegex(result.text, r"<!-- qddot:|\{\{title\}\}")
        self.assertEqual([text for tag, _, text in found if tag == "title"], ["a </title> b"])
        sources = [attributes["src"] for _, attributes, _ in found if "src" in attributes]
        self.assertEqual([source for source in sources if not source.startswith("data:")], [])

    def test_every_file_of_the_page_is_packed(self):
        known = set()
        for script in page.SCRIPTS:
            page.with_imports(script, known)
        own = [file.relative_to(page.HOME) for file in (page.HOME / "page").rglob("*.[jc]s*")]
        packed = [name for name in [*known, *page.STYLES] if name.startswith("page/")]
        self.assertEqual(sorted(map(str, own)), sorted(packed))

    def test_modules_export_all_that_is_imported_and_no_name_twice(self):
        modules = {file.name: file.read_text() for file in (page.HOME / "page/js").iterdir()}
        exported = {
            name: [found[1] for found in page.EXPORT.findall(text)]
            for name, text in modules.items()
        }
        every = sorted(sum(exported.values(), []))
        self.assertEqual(every, sorted(set(every)))
        for name, text in modules.items():
            for names, file in page.IMPORT.findall(text):
                wanted = {one.strip() for one in names.split(",")} - {""}
                self.assertLessEqual(wanted, set(exported[file]), f"{name} from {file}")


if __name__ == "__main__":
    unittest.main()
