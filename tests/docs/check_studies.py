"""The studies behind the pages: what makes one old, what is measured again, what is kept and how its
numbers are worded."""

import contextlib
import io
import json
import math
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import chart_data
import page_data
import study as entries
import studies


class Studies(unittest.TestCase):
    def setUp(self):
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name in ("DATA", "PICTURES", "RESULTS"):
            self.enterContext(mock.patch.object(entries, name, folder / name.lower()))
        self.list = entries.Study("list", ["simulate --list-methods --csv"], text="m.csv")

    def check(self, *studies_):
        """What --check says of these, and whether it is content."""
        with contextlib.redirect_stdout(io.StringIO()) as said:
            good = studies.check({study.name: study for study in studies_})
        return good, said.getvalue()

    def rewrite(self, study, **changes):
        """Changes the record of a study."""
        (study.data / "study.json").write_text(json.dumps({**study.record, **changes}))

    def test_a_study_is_kept_whole_and_measured_where_it_is_another(self):
        scene = "examples/two_links.toml"
        command = f"convergence --scene {scene} --until 0.1 --methods verlet,rk4"
        study = entries.Study("small", [command], tables=["order.csv"])
        self.assertEqual("not measured", study.due())
        studies.make(study, again=False)
        self.assertIn("\nrk4,", (study.data / "order.csv").read_text())
        self.assertFalse(list(entries.DATA.rglob("*.part")))
        self.assertFalse((study.folder / "begun.json").exists())
        sidecar = json.loads((study.folder / "order.json").read_text())
        for key in ("version", "source_hash", "compiler"):
            self.assertEqual(sidecar[key], study.record[key])
        self.assertTrue(self.check(study)[0])
        self.rewrite(study, needs={scene: "another"})
        self.assertEqual((False, f"small: changed since: {scene}\n"), self.check(study))
        study.commands = ["convergence --scene oscillator --until 1"]
        self.assertIn("small: measured by another command", self.check(study)[1])
        bad = entries.Study("bad", ["convergence --scene nothing"], tables=["order.csv"])
        with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
            studies.make(bad, again=False)
        self.assertIsNone(bad.record)

    def test_commits_since_are_counted(self):
        studies.make(self.list, again=False)
        with mock.patch.object(entries, "commits_after", lambda commit, *programs: len(commit)):
            self.rewrite(self.list, version="0.1.0 (abc-dirty)")
            said = "3 commits changed code since these were measured: list\n"
            self.assertEqual((True, said), self.check(self.list))
        self.rewrite(self.list, version="0.1.0")
        self.assertIn("an unknown number of commits", self.check(self.list)[1])
        self.assertIn(entries.commits_after("HEAD", "convergence"), (0, None))
        self.assertIsNone(entries.commits_after("no_commit", "convergence"))

    def test_an_interrupted_study_goes_on_and_one_of_other_sources_begins_anew(self):
        study = self.list
        study.folder.mkdir(parents=True)
        for sources, goes_on in ((entries.source_hash(), True), ("others", False)):
            begun = {"source_hash": sources, "commands": study.commands, "seconds": 100}
            (study.folder / "begun.json").write_text(json.dumps(begun))
            (study.folder / "journal").write_text("a piece")
            studies.make(study, again=False)
            self.assertEqual(goes_on, (study.folder / "journal").exists())
            self.assertEqual(goes_on, study.record["seconds"] >= 100)

    def test_a_study_follows_what_it_needs_and_a_quick_one_what_is_printed(self):
        needed = entries.Study("needed", ["simulate --list-scenes --csv"], text="s.csv")
        self.list.needs, known = ["needed"], {"needed": needed, "list": self.list}
        self.enterContext(mock.patch.object(studies, "read_studies", lambda: known))
        studies.make(self.list, again=False)
        self.assertIsNotNone(needed.record)
        self.assertEqual("", self.list.due())
        self.rewrite(needed, date="another day")
        self.assertEqual((False, "list: changed since: needed\n"), self.check(self.list))
        self.list.quick = True
        self.assertEqual("", self.list.due())
        (entries.DATA / "list/m.csv").write_text("name\n")
        self.assertEqual("prints another text", self.list.due())


class Words(unittest.TestCase):
    def test_numbers(self):
        for value, words in ((0.00098, "0.98 ms"), (1.23e-5, "12 µs"), (9.96e-5, "0.10 ms"), (0.1234, "0.12 s"),
                             (99.6, "1 min 40 s"), (120, "2 min"), (3e-8, "30 ns"), (0.0099, "9.9 ms")):  # fmt: skip
            self.assertEqual(words, page_data.seconds(value))
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
        lost = {1: (2, 1), 10: (2, 1), 100: (1, 2), 1000: (2, 1)}
        self.assertAlmostEqual(math.sqrt(1e5), self.crossing_of(lost), 6)
