#!/usr/bin/python3
"""Checks that the page's answers are those of the study's front, and that simulate takes the commands
of the page. The programs are in the folder QDDOT_BIN."""

import csv
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import answers
from commands import RunCommands
from study_folder import read_study

STUDIES = {
    "cloth": "--scene cloth --until 0.01 --methods symplectic_euler,verlet,blanes_moan4,cvode_adams",
    "own_options": "--scene orbit --methods verlet,cvode_bdf,implicit_midpoint --until 0.5"
    " --max-order 3 --solver cholmod --accuracies 0.03",
}


class Studies(unittest.TestCase):
    """Real studies, each made once."""

    bin = Path(os.environ.get("QDDOT_BIN", "build/bin")).resolve()

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.root = Path(temporary.name)
        for name, options in STUDIES.items():
            # Runs that take longer are points without an error; which ones, decides nothing here.
            words = [*options.split(), "--repeats", "1", "--point-limit", "0.02", "--out", name]
            subprocess.run(
                [cls.bin / "work_precision", *words], cwd=cls.root, capture_output=True, check=True
            )

    def test_the_answers_are_those_of_the_front(self):
        for name, asked in {"cloth": None, "own_options": ["0.03"]}.items():
            folder = self.root / name
            if asked:
                sidecar = json.loads((folder / "points.json").read_text())
                self.assertEqual(sidecar["study"]["options"]["--accuracies"], asked)
            study = read_study(str(folder))
            with open(folder / "front.csv", newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            expected = [
                (float(row["accuracy"]), row["method"])
                for row in rows
                if asked or 1e-8 <= float(row["accuracy"]) <= 1e-2
            ]
            found = [
                (answer["accuracy"], "" if point is None else study.runs[point].method)
                for answer in answers.answers(study)
                for point in [answer["point"]]
            ]
            self.assertEqual(found, expected)

    def test_what_an_answer_says(self):
        row = {"accuracy": 1e-2, "point": 3, "runner_up": 5, "ratio": 2.0, "why_empty": None}
        row |= {"others": [{"family": "sundials", "point": 5, "ratio": 2.0}]}
        row |= {"warnings": ["2.9 % below its limit of stability", "doubtful"]}
        found = answers.answer(row)
        self.assertEqual(found["next"], {"point": 5, "ratio": 2.0})
        self.assertEqual(found["others"], [{"family": "SUNDIALS", "point": 5, "ratio": 2.0}])
        self.assertEqual(found["warning"], "2.9 % below its limit of stability; doubtful")
        self.assertEqual(answers.answers_note([found]).count("half"), 1)
        row |= {"point": None, "runner_up": None, "others": [], "warnings": []}
        empty = answers.answer(row | {"why_empty": "no method reached it"})
        self.assertEqual((empty["next"], empty["why"]), (None, "no method reached it"))
        self.assertIsNone(answers.answers_note([empty]))

    def test_each_failure_has_a_sentence_and_each_method_a_line(self):
        for name in STUDIES:
            sidecar = json.loads((self.root / name / "points.json").read_text())
            study = read_study(str(self.root / name))
            failed = {run.outcome for run in study.runs} - {"reached_end"}
            self.assertEqual(failed, set(sidecar["outcomes"]))
            self.assertEqual({run.method for run in study.runs}, set(study.method_notes))

    def test_simulate_takes_the_commands_of_the_runs(self):
        study = read_study(str(self.root / "own_options"))
        commands = RunCommands(study)
        for method in study.method_notes:
            run = next(r for r in study.runs if r.method == method and r.outcome == "reached_end")
            line = commands.of_run(run.method, run.knob, run.value)
            done = subprocess.run(
                line.replace("build/bin/simulate", str(self.bin / "simulate"), 1),
                shell=True,
                cwd=self.root,
                capture_output=True,
                text=True,
                check=False,
            )
            self.assertEqual(done.returncode, 0, f"{line}: {done.stderr}")
        self.assertIn("--max-order 3", line_of(commands, study, "cvode_bdf"))
        self.assertIn("--solver cholmod", line_of(commands, study, "implicit_midpoint"))
        self.assertNotIn("--solver", line_of(commands, study, "verlet"))


def line_of(commands, study, method):
    """The command of some run of a method."""
    run = next(run for run in study.runs if run.method == method)
    return commands.of_run(run.method, run.knob, run.value)


if __name__ == "__main__":
    unittest.main()
