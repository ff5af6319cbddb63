"""Checks work-precision charts of hand-made tables, which the study's program in the folder QDDOT_BIN
judges: the names of methods, the key, the strip of failures, and that --all shows every method."""

import json
from pathlib import Path
from xml.etree import ElementTree

from programs import Programs
from study_tables import draw, judge, texts_of, write_table

COLUMNS = (
    "scene method family stock_of knob value outcome t_reached error_position error_velocity"
    " error_energy error_energy_max error_momentum_max error_modal_shares time_s time_min_s setup_s"
    " steps energy_growth solves"
).split()
EXPLICIT, SOLVING, SUNDIALS, STOCK = "verlet", "implicit_midpoint", "cvode_bdf", "cvode_bdf_klu"
PROMINENT = (EXPLICIT, SOLVING, SUNDIALS, STOCK)
SLOWER = (
    "explicit_euler symplectic_euler semi_implicit_euler position_verlet rk4 blanes_moan4"
    " blanes_moan6 kahan_li8 takahashi_imada4 symmetric4 symmetric6 symmetric8 symmetric10 dprkn6"
    " dprkn8 dprkn12 linear_midpoint linear_midpoint4 multirate_adams2 multirate_adams4"
    " multirate_adams5"
).split()
CHART, WHICH = "work_precision/work_precision.py", "work_precision/which_method.py"
ABOUT = {"scene": {"name": "made", "nodes": 2, "springs": 1}, "until": 2, "cpu": "a processor"}
ABOUT |= {"reduced": {"largest_stable_step": 0.01}}


def a_sweep(method, time, **others):
    """Three points of a method of order 2, and one beyond that diverged."""
    row = {"scene": "hand-made", "family": "hand-written", "method": method, "solves": 0}
    row |= {"knob": "step_size", "outcome": "reached_end"} | others
    return [
        row | {"value": h, "error_position": h * h, "error_energy_max": h * h, "time_s": time / h}
        for h in (1e-4, 1e-3, 1e-2)
    ] + [row | {"value": 1e-1, "outcome": "diverged"}]


def crowd(count=14):
    """The best of four kinds, and slower methods."""
    rows = a_sweep(EXPLICIT, 1e-6) + a_sweep(SOLVING, 2e-6, solves=10)
    rows += a_sweep(SUNDIALS, 3e-6, family="sundials", solves=10)
    rows += a_sweep(STOCK, 4e-6, family="sundials", stock_of=SUNDIALS, solves=10)
    return rows + [row for i in range(count) for row in a_sweep(SLOWER[i], 1e-5 * (1 + i))]


def write_study(folder, rows, columns=COLUMNS, reference=None, **about):
    """The tables of a study with these rows, and their record."""
    write_table(folder / "points.csv", rows, columns)
    (folder / "points.json").write_text(json.dumps(about))
    (folder / "reference.json").write_text(json.dumps(reference or {"until": 1}))
    judge(folder)


class HandMade(Programs):
    """Tests on tables in a folder of their own."""

    def setUp(self):
        super().setUp()
        self.folder = Path.cwd()


class Charts(HandMade):
    """Texts that are to be read on a chart."""

    def chart(self, *options):
        """The texts of the chart, in the order of drawing, and its height in inches."""
        self.assertEqual(draw(CHART, *options, self.folder), (0, ""))
        picture = self.folder / "chart.svg"
        height = ElementTree.parse(picture).getroot().get("height").removesuffix("pt")
        return texts_of(picture), float(height) / 72

    def test_only_what_stands_out_has_its_name_unless_all_are_wanted(self):
        write_study(self.folder, crowd(21), interrupted="a signal")
        _, low = self.chart()
        for name in ("chart", "chart_energy"):
            texts = texts_of(self.folder / f"{name}.svg")
            self.assertLessEqual(set(PROMINENT), set(texts))
            self.assertFalse(set(texts).intersection(SLOWER))
            pale = "pale: 21 other methods (--all names them)"
            self.holds(texts, pale, "its stock way, KLU", "25 of 25 methods; --all shows each")
            self.assertIn("h ≥ 0.1", texts)  # one limit for all
            said = "The study was interrupted by a signal: points are missing."
            self.assertIn(said, " ".join(texts))
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
        usage = "Usage: work_precision.py DIR [--all]\n"
        self.assertEqual(draw(CHART, self.folder, "--everything"), (2, usage))

    def test_few_methods_are_all_named(self):
        write_study(self.folder, crowd(8))
        texts, _ = self.chart()
        self.assertLessEqual(set(SLOWER[:8]), set(texts))
        self.assertFalse([text for text in texts if text.startswith("pale")])
        write_study(self.folder, a_sweep(EXPLICIT, 1e-6))
        texts, _ = self.chart()
        self.holds(texts, "1 of 1 method; --all shows each", f"h ≥ 0.1 ({EXPLICIT})")

    def test_failures_only(self):
        write_study(self.folder, [row for row in crowd() if row["outcome"] == "diverged"])
        texts, height = self.chart()
        self.holds(texts, "no run gave a point", "no point at all")
        self.assertTrue([text for text in texts if text.startswith(EXPLICIT) and "more" in text])
        # Axes of 3.4 in with what is around them, and a strip of two lines.
        self.assertLess(height, 6.5)
        self.assertEqual(self.chart("--all")[0].count("diverged at h = 0.1"), 18)

    def test_a_table_without_families(self):
        unknown = {"family", "stock_of", "solves"}
        write_study(self.folder, crowd(), [name for name in COLUMNS if name not in unknown])
        texts, _ = self.chart()
        self.assertIn(EXPLICIT, texts)
        self.assertNotIn(SUNDIALS, texts)
        self.assertIn("pale: 17 other methods (--all names them)", texts)

    def test_beyond_the_horizon_all_panels_have_one_emphasis(self):
        rows = [{**row, "error_momentum_max": row.get("error_position", "")} for row in crowd()]
        reference = {"until": 2, "beyond_horizon": True, "horizon": 1, "lyapunov": 20}
        write_study(self.folder, rows, reference={**reference, "modal_shares_floor": 0})
        texts, _ = self.chart()
        for method in PROMINENT:
            self.assertGreaterEqual(texts.count(method), 2)
        self.assertFalse(set(texts).intersection(SLOWER))
        self.assertIn("relative momentum error", texts)
        self.assertTrue([text for text in texts if text.startswith("chaotic: from t = 1 s on")])

    def test_the_fastest_methods_by_scene(self):
        write_study(self.folder, crowd(), **ABOUT)
        picture = self.folder / "which.svg"
        self.assertEqual(draw(WHICH, picture, self.folder), (0, ""))
        texts = texts_of(picture)
        for words in ("made", "2 nodes, 1 spring", "2 s, 200 steps", EXPLICIT, "Euler and Verlet"):
            self.assertIn(words, texts)
        # The steps of SUNDIALS take three times as long.
        self.assertIn("3.0 ×", texts)
        self.assertTrue([text for text in texts if "one core of a processor" in text])
        # The missing file is named, and no picture is written.
        picture.unlink()
        sidecar = self.folder / "points.json"
        sidecar.write_text("{}")
        said = f"{sidecar} cannot be read: 'scene'.\n"
        self.assertEqual(draw(WHICH, picture, self.folder), (2, said))
        self.assertFalse(picture.exists())
