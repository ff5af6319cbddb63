#!/usr/bin/python3
"""Checks that the page's answers are those of the study: of front.csv and of the printed table.
Also checks their words on margins, doubts and accuracies that nothing reached. The programs are in
the folder QDDOT_BIN."""

import csv
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import answers
import made_folder
import measurements
from commands import RunCommands
from study_folder import Study, digits, read_study
from style import family_look

# The chain's end is beyond the horizon of its chaotic motion.
CHAOTIC = 'until = 12\n[generator]\nkind = "chain"\nnodes = 4\nstiffness = 1000\n'
STUDIES = {
    "pendulum": "--scene pendulum --methods verlet,symmetric4,symmetric8,rk4,ida,arkode_erk8",
    "cloth": "--scene cloth --until 0.01 --methods symplectic_euler,verlet,blanes_moan4,cvode_adams",
    "poor": "--scene orbit --methods explicit_euler --until 0.5",
    "own_options": "--scene orbit --methods verlet,cvode_bdf,implicit_midpoint --until 0.5"
    " --max-order 3 --solver cholmod",
    "chaotic": "--scene chaotic.toml --methods verlet,blanes_moan6,arkode_erk5",
}
TIMES = {"us": 1e-6, "ms": 1e-3, "s": 1.0}


def a_run(method="verlet", error=1e-3, time=1.0, **others):
    """A run that reached the end."""
    facts = {"scene": "s", "family": "hand-written", "stock_of": "", "knob": "step_size"}
    facts |= {"method": method, "value": 1e-3, "outcome": "reached_end", "error": error}
    return measurements.Run(**(facts | {"time": time} | others))


def a_study(certified=1e-12, margins=()):
    """A study whose answers are judged by positions."""
    reference = measurements.Reference("s", 1.0, certified, None)
    return Study("", [], [], [], {}, reference, {}, None, dict(margins))


class Sentences(unittest.TestCase):
    """What an answer says."""

    def answer(self, *runs, accuracy=1e-2, **study):
        """The answer at one accuracy."""
        return answers.answer(a_study(**study), list(runs), accuracy)

    def test_the_next_is_another_method_and_others_are_of_other_families(self):
        found = self.answer(
            a_run("a", time=1.0),
            a_run("a", time=1.5),
            a_run("b", time=2.0),
            a_run("c", time=4.0, family="sundials"),
            a_run("d", time=8.0, family="sundials"),
        )
        self.assertEqual((found["point"], found["why"]), (0, None))
        self.assertEqual(found["next"], {"point": 2, "ratio": 2.0})
        self.assertEqual(found["others"], [{"family": "SUNDIALS", "point": 3, "ratio": 4.0}])

    def test_of_two_as_fast_the_first_counts(self):
        self.assertEqual(self.answer(a_run("b"), a_run("a"))["point"], 0)

    def test_why_there_is_none(self):
        known = (1e-3, 2e-2)
        for words, options in {
            "beyond what the reference certifies": {"certified": 0.1},
            "no method is known to have reached it": {},
        }.items():
            found = self.answer(a_run(error=1e-2, known=known), **options)
            self.assertEqual((found["point"], found["why"]), (None, words))
        for run in (a_run(error=0.1), a_run(outcome="diverged"), a_run(counts=False)):
            self.assertEqual(self.answer(run)["why"], "no method reached it")
        self.assertEqual(self.answer()["why"], "no method reached it")

    def test_knobs_are_spelled_as_in_the_pages_scripts(self):
        for value, words in {
            1 / 1690: "5.917e-4",
            5e-4: "5e-4",
            1e-10: "1e-10",
            0.00099999: "0.001",
            0.02: "0.02",
            0.012345: "0.01235",
            1 / 64: "0.01563",
            12345.0: "12350",
        }.items():
            self.assertEqual(answers.knob_in_words("step_size", value), f"h = {words} s")
        self.assertEqual(answers.knob_in_words("rtol", 1e-6), "rtol = 1e-6")
        self.assertEqual(answers.knob_in_words("an_angle", 0.5), "an angle = 0.5")

    def test_a_study_that_was_asked_for_accuracies_answers_these(self):
        for words, expected in {
            ("1e-4", "1e-2"): [1e-2, 1e-4],
            ("0.5",): [0.5],
            ("2", "-1", "nan"): list(answers.ACCURACIES),
            ("a",): list(answers.ACCURACIES),
            (): list(answers.ACCURACIES),
        }.items():
            study = a_study()
            study.sidecar["study"] = {"options": {"--accuracies": list(words)}}
            found = [answer["accuracy"] for answer in answers.answers(study)]
            self.assertEqual(found, expected)

    def test_small_margins_are_warned_of(self):
        for margin, words in ((0.056, "5.6 % below"), (-0.34, "34 % above"), (0.15, None)):
            found = self.answer(a_run(), margins={(2, "verlet", 1e-3): margin})
            if words:
                self.assertEqual(found["warning"], f"{words} its limit of stability")
            else:
                self.assertIsNone(found["warning"])

    def test_one_note_tells_what_to_do_near_a_limit(self):
        near = self.answer(a_run(error=2e-12), margins={(2, "verlet", 1e-3): 0.029})
        self.assertRegex(
            near["warning"], "^2.9 % below its limit of stability; error known only to "
        )
        far = self.answer(a_run(error=2e-12))
        self.assertIsNone(answers.answers_note([far, self.answer()]))
        note = answers.answers_note([far, near, near])
        self.assertEqual((note.count("half"), note[-1]), (1, "."))

    def test_an_error_near_what_is_certified_is_doubted(self):
        found = self.answer(a_run(error=2e-12))
        self.assertIn("known only to within 1.0e-12", found["warning"])


class Studies(unittest.TestCase):
    """Real studies, each made once."""

    bin = Path(os.environ.get("QDDOT_BIN", "build/bin")).resolve()

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.root = Path(temporary.name)
        (cls.root / "chaotic.toml").write_text(CHAOTIC)
        cls.printed = {}
        for name, options in STUDIES.items():
            # Runs that take longer are points without an error; which ones, decides nothing here.
            words = [*options.split(), "--repeats", "1", "--point-limit", "0.02", "--out", name]
            cls.printed[name] = subprocess.run(
                [cls.bin / "work_precision", *words],
                cwd=cls.root,
                capture_output=True,
                text=True,
                check=True,
            ).stdout

    def both(self, name):
        """The study and its answers at 1e-2 to 1e-8."""
        study = read_study(str(self.root / name))
        return study, study.judged_runs(), answers.answers(study)

    def test_the_fastest_are_those_of_the_front(self):
        for name in STUDIES:
            study, runs, found = self.both(name)
            with open(self.root / name / "front.csv", newline="", encoding="utf-8") as file:
                rows = {digits(float(row["accuracy"])): row for row in csv.DictReader(file)}
            for answer in found:
                row = rows[digits(answer["accuracy"])]
                self.assertEqual(row["judged_by"], study.judged_by)
                fastest = None if answer["point"] is None else runs[answer["point"]]
                self.assertEqual(row["method"], fastest.method if fastest else "", name)
                if fastest:
                    self.assertEqual(float(row["value"]), fastest.value)
                    self.assertEqual(float(row["time_s"]), fastest.time)

    def test_the_words_are_those_that_the_study_prints(self):
        reasons = set()
        for name in STUDIES:
            study, runs, found = self.both(name)
            lines = {line[:5]: line for line in self.printed[name].splitlines()}
            for answer in found:
                line = lines[f"{answer['accuracy']:.0e}"]
                if answer["point"] is None:
                    self.assertEqual(line[10:].strip(), answer["why"])
                    reasons.add(answer["why"])
                    continue
                run = runs[answer["point"]]
                self.assertEqual(line[10:31].strip(), run.method)
                self.assertEqual(line[31:48].strip(), printed_knob(run))
                doubt = line[57] == "?"
                self.assertEqual(doubt, "known only to within" in (answer["warning"] or ""))
                self.check_rival(line, runs, answer)
            warned = [a for a in found if "limit of stability" in (a["warning"] or "")]
            for answer in warned:
                run = runs[answer["point"]]
                start = f"{run.method} at {printed_knob(run)} is"
                share = re.search(r"[0-9.e+]+ % (above|below)", answer["warning"])[0]
                self.assertIn(f"{start} {share} its limit", self.printed[name])
        self.assertIn("no method reached it", reasons)

    def check_rival(self, line, runs, answer):
        """Whether the best of the other family is the one that is printed."""
        rival = re.search(r"(\w+) [0-9.]+ \w+, ([0-9.e+]+) x$", line)
        self.assertEqual(bool(rival), bool(answer["others"]), line)
        if rival:
            other = answer["others"][0]
            self.assertEqual(runs[other["point"]].method, rival[1])
            self.assertEqual(f"{other['ratio']:.3g}", rival[2])
            self.assertEqual(family_look(runs[other["point"]].family).title, other["family"])

    def test_chaos_is_judged_by_energy(self):
        study, runs, found = self.both("chaotic")
        self.assertEqual(study.judged_by, "energy")
        self.assertTrue(any(answer["point"] is not None for answer in found))

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


def printed_knob(run):
    """A run's knob as the study's own table spells it."""
    symbol, unit = {"step_size": ("h", " s"), "rtol": ("rtol", "")}[run.knob]
    return f"{symbol} = {run.value:.4g}{unit}"


def line_of(commands, study, method):
    """The command of some run of a method."""
    run = next(run for run in study.runs if run.method == method)
    return commands.of_run(run.method, run.knob, run.value)


class MadeStudy(unittest.TestCase):
    """The made folder's front, which was made by its own formula."""

    def test_it_has_the_same_answers(self):
        with tempfile.TemporaryDirectory() as folder:
            made_folder.make_folder(folder, has_motions=False)
            study = read_study(folder)
            runs = study.judged_runs()
            for answer in answers.answers(study):
                place = next(p for p in front_of(folder) if p[0] == digits(answer["accuracy"]))
                run = runs[answer["point"]]
                self.assertEqual(place[1:], (run.method, run.value))


def front_of(folder):
    """The digits, methods and values of front.csv."""
    with open(Path(folder) / "front.csv", newline="", encoding="utf-8") as file:
        return [
            (digits(float(row["accuracy"])), row["method"], float(row["value"]))
            for row in csv.DictReader(file)
        ]


if __name__ == "__main__":
    unittest.main()
