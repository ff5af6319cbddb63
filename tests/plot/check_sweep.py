"""Checks that the picture of a sweep agrees with its hand-made tables: the fastest methods with
their times and margins, where they change, and what is left out. Nothing may overlap."""

import json
import shutil
import unittest
from itertools import combinations

from check_charts import ABOUT, COLUMNS, EXPLICIT, SOLVING, HandMade, a_sweep, crowd, write_study
from names import one_line
from sheet import Sheet
from study_tables import draw, draw_again, judge, read_table, texts_of, write_table
from style import use_style
from sweep import Crossover, read
from sweep_picture import cut, draw_title, in_two, sentences
from sweep_picture import draw as drawn

FASTEST = "scene until accuracy method knob value error time_s runner_up margin judged_by".split()
CROSSOVERS = "along accuracy low high crossing scene_low scene_high method_low method_high".split()
LONG_METHODS = ("arkode_implicit_midpoint", "local_global_chebyshev")
ACCURACIES = ("1e-2", "1e-4", "1e-6")
LONG = "framed_cloth_nodes_1000_frame_stiffness_1e9_damping_0.01_xyz"


def a_cell(scene, accuracy, method=EXPLICIT, time_s="1e-3", margin="1.34", judge="position"):
    """A row of fastest.csv."""
    row = {"scene": scene, "until": 2, "accuracy": accuracy, "judged_by": judge}
    if not method:
        return row
    row |= {"method": method, "knob": "step_size", "value": 1e-3, "error": accuracy}
    return row | {"time_s": time_s, "runner_up": "next", "margin": margin}


def a_crossover(accuracy=1e-4, low=100.0, high=1000.0, crossing=312.4, along="nodes", **others):
    """A change from verlet to blanes_moan4 along the nodes of a chain."""
    facts = {"scenes": ("chain_100", "chain_1000"), "methods": ("verlet", "blanes_moan4")}
    return Crossover(along, accuracy, low, high, crossing, **(facts | others))


class Sweep(HandMade):
    """Tests on a sweep in a folder of its own."""

    def write_scenes(self, scenes):
        """The folders of scenes, each with the runs of a crowd of methods."""
        for name in scenes:
            folder = self.folder / name
            if name != scenes[0]:  # all have the same runs
                shutil.copytree(self.folder / scenes[0], folder)
                continue
            folder.mkdir()
            rows = crowd(2) + [row for method in LONG_METHODS for row in a_sweep(method, 1e-3)]
            write_study(folder, rows, COLUMNS, {"until": 2}, **ABOUT)

    def write_sweep(self, scenes, rows=None, crossovers=(), about=None):
        """A sweep over these scenes; without rows each has one method at all accuracies."""
        self.write_scenes(scenes)
        rows = rows or [a_cell(name, accuracy) for name in scenes for accuracy in ACCURACIES]
        write_table(self.folder / "fastest.csv", rows, FASTEST)
        write_table(self.folder / "crossovers.csv", crossovers, CROSSOVERS)
        if about:
            (self.folder / "sweep.json").write_text(json.dumps(about))

    def texts(self):
        """The texts of the picture, in the order of drawing."""
        self.assertEqual(draw("sweep/sweep.py", self.folder), (0, ""))
        self.assertTrue((self.folder / "fastest.png").exists())
        return texts_of(self.folder / "fastest.svg")

    def refusal(self):
        """Why the sweep is not drawn."""
        status, said = draw("sweep/sweep.py", self.folder)
        self.assertEqual((status, said.count("\n")), (2, 1))
        self.assertEqual([*self.folder.glob("fastest.png"), *self.folder.glob("fastest.svg")], [])
        return said.strip().replace(f"{self.folder}/", "")


class WhatIsSaid(Sweep):
    """Texts that are to be read in a picture."""

    def test_the_fastest_method_its_time_and_its_margin(self):
        rows = [a_cell("chain_3", "1e-2", time_s="2.13e-3"), a_cell("chain_3", "1e-4", margin="")]
        rows += [a_cell("chain_3", "1.0000000000000001e-06", SOLVING, margin="31.4")]
        self.write_sweep(["chain_3"], rows)
        texts = self.texts()
        for words in ("chain_3", "2 nodes, 2 s, 200 steps", *ACCURACIES, "position error at most"):
            self.assertIn(words, texts)
        # One stretch over two accuracies.
        self.assertEqual((texts.count(EXPLICIT), texts.count(SOLVING)), (1, 1))
        self.assertEqual((texts.count("2.1 ms"), texts.count("1 ms")), (1, 2))
        self.assertEqual([text for text in texts if text.endswith("×")], ["1.3×", "31×", "0.3 ×"])
        self.assertIn("implicit", texts)
        # The best of SUNDIALS takes 3e-4 s at 1e-2 and 1e-4, with h = 1e-2, and 3e-3 s at 1e-6.
        self.assertIn("0.1 to 3.0", texts)
        self.assertTrue([text for text in texts if "one core of a processor" in text])
        self.assertNotIn("Where the fastest method changes", texts)

    def test_rows_and_columns_stand_in_their_order(self):
        cells = [("b", "1e-6"), ("b", "3e-4"), ("a", "0.1"), ("a", "1e-6"), ("c", "0.1")]
        self.write_sweep(["b", "a", "c"], [a_cell(*cell) for cell in cells])
        texts = self.texts()
        # Accuracies go from coarse to fine, scenes as in the file.
        heads = ("1e-1", "3e-4", "1e-6")
        self.assertEqual([text for text in texts if text in heads], list(heads))
        self.assertEqual([text for text in texts if text in "abc"], ["b", "a", "c"])
        # A cell that nobody asked for is no failure, unlike one without a method.
        self.assertNotIn("–", texts)
        nobody = [a_cell("a", accuracy, "") for accuracy in ACCURACIES]
        write_table(self.folder / "fastest.csv", nobody, FASTEST)
        self.assertEqual(self.texts().count("–"), 4)

    def test_a_folder_that_cannot_be_read_is_left_out_and_counted(self):
        rows = [a_cell(name, "1e-2") for name in ("a", "gone", "broken")]
        self.write_sweep(["a", "broken"], rows)
        (self.folder / "broken" / "points.json").write_text("{}")
        texts = self.texts()
        self.assertIn("2 scenes of fastest.csv are left out: their folders cannot be read.", texts)
        self.assertNotIn("gone", texts)
        self.assertTrue([text for text in texts if "on one scene" in text])
        (self.folder / "fastest.png").unlink()
        (self.folder / "fastest.svg").unlink()
        (self.folder / "a" / "points.csv").unlink()
        self.assertEqual(self.refusal(), "fastest.csv: no scene's folder can be read.")

    def test_sixty_scenes_are_drawn(self):
        names = [f"chain_{i}" for i in range(62)]
        self.write_sweep(names, [a_cell(name, "1e-4") for name in names])
        texts = self.texts()
        self.assertTrue([text for text in texts if "first 60 of the 62 scenes in fastest" in text])
        self.assertIn("chain_59", texts)
        self.assertNotIn("chain_60", texts)
        # The accuracies are said below so many rows again.
        self.assertEqual(texts.count("1e-4"), 2)

    def test_what_a_reader_must_know_is_said(self):
        self.write_sweep(["a"], about={"times": "work", "processor": "Xeon"})
        (self.folder / "fastest.json").write_text(json.dumps({"interrupted": "a signal"}))
        words = " ".join(self.texts())
        self.holds(
            words, "its time as computed from its work", "Times are computed, not measured",
            "on one core of Xeon", "The sweep was interrupted by a signal",
        )  # fmt: skip
        files = [self.folder / f"fastest.{end}" for end in ("png", "svg")]
        first = [file.read_bytes() for file in files]
        draw_again("sweep/sweep.py", self.folder)
        # The same numbers give the same picture.
        self.assertEqual(first, [file.read_bytes() for file in files])
        for file in files:
            file.unlink()
        self.write_sweep([], [a_cell("a", "1e-2")], about={"times": "guessed"})
        self.assertEqual(self.refusal(), "sweep.json: times is 'guessed', not measured or work.")

    def test_chaotic_scenes_are_judged_by_their_energy(self):
        self.write_sweep(["a"], [a_cell("a", "1e-2", judge="energy")])
        # The positions say nothing: of SUNDIALS the run of h = 1e-2 is good by its energy alone.
        known = {"until": 2, "beyond_horizon": True, "horizon": 1, "lyapunov": 20}
        (self.folder / "a" / "reference.json").write_text(json.dumps(known))
        path = self.folder / "a" / "points.csv"
        rows = [row | {"error_position": "1"} for row in read_table(path)]
        write_table(path, rows)
        judge(self.folder / "a")
        texts = self.texts()
        for words in ("2 nodes, 2 s, 200 steps, by energy", "error at most", "0.3 ×"):
            self.assertIn(words, texts)
        self.assertIn("By energy: the motion is chaotic", " ".join(texts))


class Refusals(Sweep):
    """Tables that are broken: one sentence, and no picture."""

    def test_no_table(self):
        self.assertEqual(draw("sweep/sweep.py"), (2, "Usage: sweep.py DIR\n"))
        self.assertEqual(self.refusal(), "fastest.csv cannot be read: No such file or directory.")
        write_table(self.folder / "fastest.csv", [], FASTEST)
        self.assertEqual(self.refusal(), "fastest.csv has no rows.")
        write_table(self.folder / "fastest.csv", [], FASTEST[:-1])
        self.assertEqual(self.refusal(), "fastest.csv has no column judged_by.")

    def test_broken_rows(self):
        self.write_scenes(["a"])
        good = [a_cell("a", "1e-2")]
        broken = {
            "2: accuracy must be a positive number": [a_cell("a", "")],
            "2: time_s is 'soon', not a number": [a_cell("a", "1e-2", time_s="soon")],
            "2: time_s must be a positive number": [a_cell("a", "1e-2", time_s="")],
            "2: margin must be a positive number": [a_cell("a", "1e-2", margin="-1")],
            "2: scene is '', not a folder's name": [a_cell("", "1e-2")],
            "2: scene is '../a', not a folder's name": [a_cell("../a", "1e-2")],
            "2: judged_by is 'eye', not position or energy": [a_cell("a", "1e-2", judge="eye")],
            "2: a has no good run of rk4": [a_cell("a", "1e-2", "rk4")],
            "3: a has its row at 0.01 already": [*good, a_cell("a", "0.01")],
            "3: a is judged by position and by energy": [*good, a_cell("a", "1", judge="energy")],
        }
        for words, rows in broken.items():
            write_table(self.folder / "fastest.csv", rows, FASTEST)
            self.assertEqual(self.refusal(), f"fastest.csv, line {words}.")
        cells = ("nodes", "1e-4", 100, 1000, "", "a", "b", "verlet", "rk4")
        change = dict(zip(CROSSOVERS, cells))
        broken = {
            "along must not be empty": {"along": ""},
            "method_high must not be empty": {"method_high": ""},
            "low and high must be numbers, the first less": {"high": 100},
            "crossing is not between low and high": {"crossing": 1001},
        }
        for words, other in broken.items():
            self.write_sweep([], good, [change | other])
            self.assertEqual(self.refusal(), f"crossovers.csv, line 2: {words}.")


class Changes(unittest.TestCase):
    """The sentences on where the fastest method changes."""

    def test_a_change_is_a_sentence(self):
        cases = {
            "chain, nodes: verlet up to some 310, then blanes_moan4, at 1e-4": a_crossover(),
            "chain, nodes: verlet up to 128, blanes_moan4 from 1,024 on, at 1e-4": a_crossover(
                low=128.0, high=1024.0, crossing=None
            ),
            "chain, until: verlet up to some 25 ms, then blanes_moan4, at 1e-4": a_crossover(
                low=0.01, high=0.1, crossing=0.025, along="until"
            ),
            "chain, gravity: verlet up to 0, blanes_moan4 from 9.81 on, at 3e-4": a_crossover(
                3e-4, 0.0, 9.81, None, along="gravity"
            ),
            "chain, stiffness: verlet up to some 2.3e6, then blanes_moan4, at 1e-4": a_crossover(
                high=1e7, crossing=2.34e6, along="stiffness"
            ),
        }
        for words, crossover in cases.items():
            self.assertEqual(sentences([crossover]), [words])

    def test_the_scene_is_what_both_names_begin_with(self):
        cases = {
            ("cloth_nodes_30", "cloth_nodes_60"): "cloth", ("cloth", "cloth_nodes_60"): "cloth",
            ("cloth_8_a", "cloth_8_b"): "cloth_8", ("soft", "stiff"): "soft to stiff",
        }  # fmt: skip
        for scenes, words in cases.items():
            [sentence] = sentences([a_crossover(scenes=scenes)])
            self.assertEqual(sentence.split(", nodes: ")[0], words)

    def test_accuracies_share_a_sentence_and_eight_are_said(self):
        crossovers = [a_crossover(accuracy) for accuracy in (1e-2, 1e-4, 1e-6)]
        [sentence] = sentences(crossovers)
        self.assertTrue(sentence.endswith("blanes_moan4, at 1e-2, 1e-4 and 1e-6"))
        crossovers += [a_crossover(crossing=100.0 * i) for i in range(4, 10)]
        crossovers += [a_crossover(along=f"a{i}") for i in (1, 1, 2, 2)]
        said = sentences(crossovers)
        self.assertEqual((len(said), said[-1]), (9, "and 2 more in crossovers.csv"))
        self.assertEqual(sentences([]), [])


class Places(Sweep):
    """Nothing is over anything else, and nothing is cut off."""

    def setUp(self):
        super().setUp()
        use_style()

    def test_names_of_any_length_fit_their_room(self):
        sheet = Sheet(4, 1)
        for name in ("a", LONG, "W" * 60, "$" * 60, "x" * 60, "y" * 200, "Щ" * 60):
            with self.subTest(name):
                lines = draw_title(sheet, 0, 0.5, 2.9, one_line(name))
                self.assertLessEqual(sheet.text_width(sheet.figure.texts[-1]), 2.9)
                self.assertEqual(lines, 1 if len(name) == 1 else 2)

    def test_names_are_broken_where_they_may_be(self):
        self.assertEqual(in_two("cloth_nodes_30"), ("cloth_", "nodes_30"))
        self.assertEqual((in_two("abcdefgh_i"), cut("abcdefgh", 5)), (("abcde", "fgh_i"), "ab…gh"))

    def test_no_text_is_over_another(self):
        # The narrowest columns, the longest names of methods and scenes, every sentence.
        names = [LONG, "W" * 60, *(f"chain_{i}" for i in range(20)), "gone"]
        digits = range(1, 10)
        rows = [
            a_cell(name, f"1e-{n}", LONG_METHODS[n % 2], "1.6e-4", "1234")
            for name in names
            for n in digits
        ]
        cells = ("nodes", "1e-4", 100, 1e7, "", LONG, LONG, "local_global_chebyshev", "symmetric4")
        change = dict(zip(CROSSOVERS, cells))
        changes = [change | {"method_low": f"local_global_chebyshev{i}"} for i in range(10)]
        self.write_sweep(names[:-1], rows, changes, {"times": "work", "processor": "Xeon"})
        figure = drawn(read(str(self.folder))).figure
        boxes = [
            (text.get_text(), text.get_window_extent(figure.canvas.get_renderer()))
            for text in figure.texts
            if text.get_text().strip()
        ]
        for words, box in boxes:
            self.assertTrue(0 < box.x0 and box.x1 < figure.bbox.x1, words)
            self.assertTrue(0 < box.y0 and box.y1 < figure.bbox.y1, words)
        for (first, box), (then, other) in combinations(boxes, 2):
            apart = box.x1 < other.x0 or other.x1 < box.x0 or box.y1 < other.y0 or other.y1 < box.y0
            self.assertTrue(apart, f"{first} is over {then}")
