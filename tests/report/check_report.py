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

import made_folder
import page
import report
from decoding import Page, elements
from packed_folder import Folder


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
        self.assertEqual(methods["ida_klu"]["stock_of"], "ida")
        self.assertEqual(methods["ida_klu"]["color"], methods["ida"]["color"])
        self.assertEqual(methods["symmetric8"]["line"], "eight, <b>bold</b>")
        self.assertLessEqual(sum(method["strong"] for method in data["methods"]), 12)
        self.assertTrue(methods["symmetric4"]["strong"])

    def test_the_page_is_one_file_with_all_its_parts(self):
        text = self.make().text
        found = elements(text)
        self.assertIn(["script", {}, "start('<!' + '-- qddot:data -->');"], found)
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
            self.assertEqual(data["methods"][run["method"]]["name"], row["method"])
            self.assertEqual(len(run["energy"]["t"]), int(row["frames"]))

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


class RealPage(unittest.TestCase):
    """The page that is shipped, with its own template, styles and scripts."""

    def test_it_holds_all_that_its_order_lists(self):
        with tempfile.TemporaryDirectory() as folder:
            made_folder.make_folder(folder, side=3, frames=3, runs=1, scene="a </title> b")
            self.assertEqual(report.main([folder]), 0)
            result = Page(Path(folder) / "report.html")
        found = elements(result.text)
        texts = [text for _, _, text in found]
        for name in page.listed(".js") + page.listed(".css"):
            self.assertIn((page.HOME / name).read_text(encoding="utf-8"), texts, name)
        self.assertNotRegex(result.text, r"<!-- qddot:|\{\{title\}\}")
        self.assertEqual([text for tag, _, text in found if tag == "title"], ["a </title> b"])
        sources = [attributes["src"] for _, attributes, _ in found if "src" in attributes]
        self.assertEqual([source for source in sources if not source.startswith("data:")], [])

    def test_every_script_of_the_page_is_listed(self):
        own = [file.relative_to(page.HOME) for file in (page.HOME / "page").rglob("*.[jc]s*")]
        listed = page.listed(".js") + page.listed(".css")
        self.assertEqual(sorted(map(str, own)), sorted(n for n in listed if n.startswith("page/")))


if __name__ == "__main__":
    unittest.main()
