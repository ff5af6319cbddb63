"""The studies behind the pages: what makes one old, what is measured again, and what is kept."""

import contextlib
import csv
import io
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/site"))
import chart_data  # noqa: E402
import code_state  # noqa: E402
import entries  # noqa: E402
import page_data  # noqa: E402
import studies  # noqa: E402

CODE = (
    'double f(double x) {  // twice\n  return name("ab") + 2 * x;  /* so */ }\nsay("it is far");\n'
)


class CodeState(unittest.TestCase):
    def test_words_and_spaces_do_not_count(self):
        for old, new in (("twice", "half"), ("so", "or"), ("  return", "\n return"),
                         ("it is far", "it went far away"), ('"it is far"', '"it is " "far off"')):  # fmt: skip
            with self.subTest(old=old):
                changed = CODE.replace(old, new)
                self.assertNotEqual(CODE, changed)
                self.assertEqual(code_state.without_words(CODE), code_state.without_words(changed))

    def test_numbers_names_and_keys_count(self):
        for old, new in (("2 *", "3 *"), ("x)", "y)"), ('"ab"', '"ac"')):
            with self.subTest(old=old):
                changed = CODE.replace(old, new)
                self.assertNotEqual(
                    code_state.without_words(CODE), code_state.without_words(changed)
                )

    def test_a_slash_in_a_string_begins_no_comment(self):
        self.assertIn("f(3)", code_state.without_words('open("a//b"); f(3);'))

    def test_a_change_is_named_by_its_folder(self):
        state = code_state.state_of(["crossover"])
        self.assertEqual([], code_state.changed(state, ["crossover"]))
        for folder in ("src/qddot/model", "integrators/methods", "experiments/crossover"):
            self.assertIn(folder, state)
            self.assertEqual(
                [folder], code_state.changed({**state, folder: "another"}, ["crossover"])
            )
        gone = {**state, "src/gone": "1"}
        self.assertEqual(["src/gone"], code_state.changed(gone, ["crossover"]))
        self.assertFalse([name for name in state if name.startswith("experiments/bench")])


class Studies(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for name in ("DATA", "PICTURES", "RESULTS"):
            patch = mock.patch.object(entries, name, self.folder / name.lower())
            patch.start()
            self.addCleanup(patch.stop)

    def test_a_study_is_kept_whole_and_made_once(self):
        study = entries.Study(
            "small",
            ["convergence --scene oscillator --until 0.5 --methods verlet,rk4"],
            tables=["order.csv"],
        )
        self.assertIsNone(study.record)
        studies.make(study, again=False)
        with open(entries.DATA / "small/order.csv", newline="", encoding="utf-8") as file:
            self.assertEqual({"verlet", "rk4"}, {row["method"] for row in csv.DictReader(file)})
        self.assertEqual(["convergence"], study.programs)
        self.assertTrue(study.is_fresh())
        self.assertEqual(study.commands, study.record["commands"])
        self.assertFalse(list(entries.DATA.rglob("*.part")))
        self.assertFalse((study.folder / "begun.json").exists())
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self.assertTrue(studies.check({"small": study}))
            record = {**study.record, "code": {**study.record["code"], "src/qddot/model": "another"}}
            (entries.DATA / "small/study.json").write_text(json.dumps(record))
            self.assertFalse(studies.check({"small": study}))
            study.commands = ["convergence --scene oscillator --until 1"]
            self.assertFalse(studies.check({"small": study}))
        self.assertIn("small: older than src/qddot/model\n", said.getvalue())
        self.assertIn("small: measured by another command", said.getvalue())

    def test_an_interrupted_study_goes_on_and_one_of_other_sources_begins_anew(self):
        study = entries.Study("list", ["simulate --list-methods --csv"], text="m.csv")
        study.folder.mkdir(parents=True)
        for sources, goes_on in ((code_state.source_hash(), True), ("others", False)):
            begun = {"sources": sources, "commands": study.commands, "seconds": 100}
            (study.folder / "begun.json").write_text(json.dumps(begun))
            (study.folder / "journal").write_text("a piece")
            studies.make(study, again=False)
            self.assertEqual(goes_on, (study.folder / "journal").exists())
            self.assertEqual(goes_on, study.record["seconds"] >= 100)

    def test_a_study_is_old_where_one_that_it_needs_was_made_again(self):
        needed = entries.Study("needed", ["simulate --list-scenes --csv"], text="s.csv")
        study = entries.Study(
            "list", ["simulate --list-methods --csv"], text="m.csv", needs=["needed"]
        )
        known = mock.patch.object(
            studies, "read_studies", lambda: {"needed": needed, "list": study}
        )
        known.start()
        self.addCleanup(known.stop)
        studies.make(study, again=False)
        self.assertIsNotNone(needed.record)
        studies.make(needed, again=False)
        studies.make(study, again=False)
        self.assertTrue(study.is_fresh())
        record = {**needed.record, "date": "another day"}
        (entries.DATA / "needed/study.json").write_text(json.dumps(record))
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self.assertFalse(studies.check({"list": study}))
        self.assertEqual("list: older than needed\n", said.getvalue())

    def test_a_study_that_fails_keeps_nothing(self):
        study = entries.Study("bad", ["convergence --scene nothing"], tables=["order.csv"])
        with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
            studies.make(study, again=False)
        self.assertIsNone(study.record)

    def test_a_quick_one_is_old_where_it_prints_another_text(self):
        study = entries.Study("list", ["simulate --list-methods --csv"], text="m.csv", quick=True)
        studies.make(study, again=False)
        self.assertTrue(study.is_fresh())
        (entries.DATA / "list/m.csv").write_text("name\n")
        self.assertFalse(study.is_fresh())


class Words(unittest.TestCase):
    def test_times(self):
        for value, words in ((0.00098, "0.98 ms"), (1.23e-5, "12 µs"), (9.96e-5, "0.10 ms"), (0.1234, "0.12 s"),
                             (99.6, "1 min 40 s"), (120, "2 min"), (3e-8, "30 ns"), (0.0099, "9.9 ms")):  # fmt: skip
            self.assertEqual(words, page_data.seconds(value))

    def test_figures(self):
        for value, words in ((1.04, "1.0"), (12.5, "12"), (12345, "12,000"), (9.1e-7, "9.1e-7"), (0, "0"),
                             (-0.25, "−0.25"), (float("inf"), "∞"), (1e-4, "1e-4"), (0.996, "1.0")):  # fmt: skip
            self.assertEqual(words, page_data.figures(value))
        self.assertEqual("1e-3", page_data.accuracy(0.001))
        self.assertEqual("97 %", page_data.percent(0.974))

    def test_what_is_not_there_is_an_error(self):
        for call in (
            lambda: page_data.record("nothing"),
            lambda: page_data.rows("methods", "nothing.csv"),
            lambda: page_data.rows("methods", "methods.csv", nothing=1),
            lambda: page_data.row("methods", "methods.csv", family="sundials"),
            lambda: page_data.sample("README.md", "a line that nobody wrote " * 2),
        ):
            with self.assertRaises(page_data.BadPage):
                call()

    def crossing_of(self, times):
        """The crossing of kinds with these times by ratio, explicit and implicit; None: not reached."""
        cells = [
            {"stiffness_ratio": ratio, "kind": kind, "method": time and "m", "time_s": time or ""}
            for ratio, pair in times.items()
            for kind, time in zip(("explicit", "implicit"), pair)
        ]
        with mock.patch.object(chart_data, "rows", lambda *_, **__: cells):
            return chart_data.crossing("made", 1e-3)

    def test_a_crossing_lies_where_both_take_as_long(self):
        # Explicit time grows as the root of the ratio, implicit time stays: they meet at 900.
        times = {10.0**n: (10 ** (n / 2), 30) for n in range(7)}
        self.assertAlmostEqual(900, self.crossing_of(times), places=6)
        self.assertEqual(1, self.crossing_of({1: (2, 1), 10: (3, 1)}))
        self.assertTrue(math.isnan(self.crossing_of({1: (1, 2), 10: (1, 2)})))
        # Beyond a ratio that explicit methods do not reach, implicit ones are ahead; where neither
        # does, nothing is known.
        self.assertEqual(10, self.crossing_of({1: (1, 2), 10: (None, 2), 100: (None, None)}))
        # An advantage that is lost again is none.
        self.assertAlmostEqual(
            math.sqrt(1e5), self.crossing_of({1: (2, 1), 10: (2, 1), 100: (1, 2), 1000: (2, 1)}), 6
        )

    def test_the_fastest_is_the_fastest(self):
        runs = [run for run in chart_data.runs("cloth") if not run.failure and run.bound <= 1e-4]
        best = chart_data.fastest("cloth", 1e-4)
        self.assertEqual(min(run.time for run in runs), best.seconds)
        second = chart_data.fastest("cloth", 1e-4, but=[best.method])
        self.assertGreaterEqual(second.seconds, best.seconds)
        self.assertNotEqual(second.method, best.method)
        self.assertFalse(chart_data.fastest("cloth", 1e-4, of=["explicit_euler"]))


if __name__ == "__main__":
    unittest.main()
