#!/usr/bin/python3
"""Checks work-precision charts of hand-made tables, which the study's program in the folder QDDOT_BIN
judges: the names of methods, the key, the strip of failures, and that --all shows every method."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

EXPERIMENTS = Path(__file__).resolve().parents[2] / "experiments"
PROGRAMS = Path(os.environ.get("QDDOT_BIN", "build/bin")).resolve()
COLUMNS = (
    "scene method family stock_of knob value outcome t_reached error_position error_velocity"
    " error_energy error_energy_max error_momentum_max error_modal_shares time_s time_min_s setup_s"
    " steps energy_growth solves"
)
EXPLICIT, SOLVING, SUNDIALS, STOCK = "verlet", "implicit_midpoint", "cvode_bdf", "cvode_bdf_klu"
SLOWER = (
    "explicit_euler symplectic_euler semi_implicit_euler position_verlet rk4 blanes_moan4"
    " blanes_moan6 kahan_li8 takahashi_imada4 symmetric4 symmetric6 symmetric8 symmetric10 dprkn6"
    " dprkn8 dprkn12 linear_midpoint linear_midpoint4 multirate_adams2 multirate_adams4"
    " multirate_adams5"
).split()


def draw(script, *words):
    """Runs a script that draws, as ./run does."""
    environment = {**os.environ, "PYTHONPATH": str(EXPERIMENTS / "plot")}
    return subprocess.run(
        [sys.executable, "-B", EXPERIMENTS / script, *words],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def judge(folder):
    """Makes the record of the tables in a folder."""
    words = [PROGRAMS / "work_precision", "--judge", folder, "--force"]
    subprocess.run(words, capture_output=True, check=True)


def a_row(method, value, error, time, **others):
    """One row of points.csv by its columns."""
    row = dict.fromkeys(COLUMNS.split(), "") | {"scene": "hand-made", "family": "hand-written"}
    row |= {"method": method, "knob": "step_size", "value": value, "outcome": "reached_end"}
    row |= {"error_position": error, "error_energy_max": error, "time_s": time, "solves": 0}
    return row | others


def a_sweep(method, time, **others):
    """Three points of a method of order 2, and one beyond that diverged."""
    points = [a_row(method, h, h * h, time / h, **others) for h in (1e-4, 1e-3, 1e-2)]
    return [*points, a_row(method, 1e-1, "", "", **others | {"outcome": "diverged"})]


def crowd(count=14):
    """The best of four kinds, and slower methods."""
    rows = a_sweep(EXPLICIT, 1e-6) + a_sweep(SOLVING, 2e-6, solves=10)
    rows += a_sweep(SUNDIALS, 3e-6, family="sundials", solves=10)
    rows += a_sweep(STOCK, 4e-6, family="sundials", stock_of=SUNDIALS, solves=10)
    for i in range(count):
        rows += a_sweep(SLOWER[i], 1e-5 * (1 + i))
    return rows


class HandMade(unittest.TestCase):
    """Tests on the tables of a study in a folder of their own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, rows, columns=COLUMNS, reference=None, interrupted=None):
        """The tables of a study with these rows, and their record."""
        names = columns.split()
        lines = [",".join(names), *(",".join(str(row[name]) for name in names) for row in rows)]
        (self.folder / "points.csv").write_text("\n".join(lines) + "\n")
        (self.folder / "points.json").write_text(json.dumps({"interrupted": interrupted}))
        (self.folder / "reference.json").write_text(json.dumps(reference or {"until": 1}))
        judge(self.folder)

    def chart(self, *options, name="chart"):
        """The texts of a chart, in the order of drawing, and its height in inches."""
        done = draw("work_precision/work_precision.py", self.folder, *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        root = ElementTree.parse(self.folder / f"{name}.svg").getroot()
        texts = [text.strip() for text in root.itertext() if text.strip()]
        return texts, float(root.get("height").removesuffix("pt")) / 72


class Charts(HandMade):
    """What is to be read on a chart."""

    def test_only_what_stands_out_has_its_name(self):
        self.write(crowd())
        for name in ("chart", "chart_energy"):
            texts, _ = self.chart(name=name)
            for method in (EXPLICIT, SOLVING, SUNDIALS, STOCK):
                self.assertIn(method, texts)
            self.assertFalse(set(texts).intersection(SLOWER))
            self.assertIn("pale: 14 other methods (--all names them)", texts)
            self.assertIn("its stock way, KLU", texts)
            self.assertIn("18 of 18 methods; --all shows each", texts)
            self.assertIn("h ≥ 0.1", texts)  # one limit for all

    def test_all_names_every_method_and_shows_each_failure(self):
        self.write(crowd(21))
        _, low = self.chart()
        texts, high = self.chart("--all")
        for name in SLOWER:
            # The name is on its line and before its row of the strip.
            self.assertEqual(texts.count(name), 2)
        self.assertEqual(texts.count("diverged at h ≥ 0.1"), 25)
        # More than 24 lines are a crowd.
        self.assertIn("faint: never within 3 × the fastest at errors below 0.1", texts)
        self.assertFalse([text for text in texts if text.startswith("pale")])
        # 25 rows of 0.17 in for failures in the place of one line, and room for 25 labels.
        self.assertGreater(high - low, 24 * 0.17)

    def test_all_may_stand_before_the_folder(self):
        self.write(crowd(2))
        done = draw("work_precision/work_precision.py", "--all", self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_word_that_is_none_is_refused(self):
        done = draw("work_precision/work_precision.py", self.folder, "--everything")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, "Usage: work_precision.py DIR [--all]\n")

    def test_a_dozen_methods_are_all_named(self):
        self.write(crowd(8))
        texts, _ = self.chart()
        self.assertTrue(set(SLOWER[:8]).issubset(texts))
        self.assertFalse([text for text in texts if text.startswith("pale")])

    def test_one_method_alone(self):
        self.write(a_sweep(EXPLICIT, 1e-6))
        texts, _ = self.chart()
        self.assertIn("1 of 1 method; --all shows each", texts)
        self.assertIn(f"h ≥ 0.1 ({EXPLICIT})", texts)

    def test_failures_only(self):
        rows = [row for row in crowd() if row["outcome"] == "diverged"]
        self.write(rows)
        texts, height = self.chart()
        self.assertIn("no run gave a point", texts)
        self.assertIn("no point at all", texts)
        self.assertTrue([text for text in texts if text.startswith(EXPLICIT) and "more" in text])
        # Axes of 3.4 in with what is around them, and a strip of two lines.
        self.assertLess(height, 6.5)
        self.assertEqual(self.chart("--all")[0].count("diverged at h = 0.1"), 18)

    def test_an_interrupted_study_says_so(self):
        self.write(crowd(), interrupted="a signal")
        words = " ".join(self.chart()[0])
        self.assertIn("The study was interrupted by a signal: points are missing.", words)

    def test_a_table_without_families(self):
        columns = COLUMNS.replace(" family stock_of", "").replace(" solves", "")
        self.write(crowd(), columns)
        texts, _ = self.chart()
        self.assertIn(EXPLICIT, texts)
        self.assertNotIn(SUNDIALS, texts)
        self.assertIn("pale: 17 other methods (--all names them)", texts)

    def test_beyond_the_horizon_all_panels_have_one_emphasis(self):
        rows = [{**row, "error_momentum_max": row["error_position"]} for row in crowd()]
        reference = {"until": 2, "beyond_horizon": True, "horizon": 1, "lyapunov": 20}
        self.write(rows, reference={**reference, "modal_shares_floor": 0})
        texts, _ = self.chart()
        for method in (EXPLICIT, SOLVING, SUNDIALS, STOCK):
            self.assertGreaterEqual(texts.count(method), 2)
        self.assertFalse(set(texts).intersection(SLOWER))
        self.assertIn("relative momentum error", texts)
        self.assertTrue([text for text in texts if text.startswith("chaotic: from t = 1 s on")])


class WhichMethod(HandMade):
    """The picture of the fastest methods by scene."""

    def test_it_names_the_fastest_and_how_much_longer_sundials_takes(self):
        self.write(crowd())
        about = {
            "scene": {"name": "made", "nodes": 2, "springs": 1},
            "until": 2,
            "cpu": "a processor",
        }
        about["reduced"] = {"largest_stable_step": 0.01}
        sidecar = self.folder / "points.json"
        sidecar.write_text(json.dumps(about))
        picture = self.folder / "which.svg"
        done = draw("work_precision/which_method.py", picture, self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        texts = [text.strip() for text in ElementTree.parse(picture).getroot().itertext()]
        for words in ("made", "2 nodes, 1 spring", "2 s, 200 steps", EXPLICIT, "Euler and Verlet"):
            self.assertIn(words, texts)
        # The steps of SUNDIALS take three times as long.
        self.assertIn("3.0 ×", texts)
        self.assertTrue([text for text in texts if "one core of a processor" in text])
        # The missing file is named, and no picture is written.
        picture.unlink()
        sidecar.write_text("{}")
        done = draw("work_precision/which_method.py", picture, self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, f"{sidecar} cannot be read: 'scene'.\n")
        self.assertFalse(picture.exists())


if __name__ == "__main__":
    unittest.main()
