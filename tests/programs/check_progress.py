"""The line that says how far a study is, in terminals and elsewhere.

usage: check_progress.py --bin FOLDER [unittest options]
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest

from studies import STUDIES, write_scenes
from terminal import Terminal

BIN = os.path.abspath(sys.argv.pop(sys.argv.index("--bin") + 1))
sys.argv.remove("--bin")

# These have no line, or may end before they say anything.
WITHOUT = {"local_global", "stock_sundials", "solvers"}
LONG = "--scene steady.toml --repeats 1000 --point-limit 1000 --until 0.02".split()


class Progress(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        write_scenes(".")

    def argv(self, program, *more, out="out"):
        return [f"{BIN}/{program}", *STUDIES[program].split(), "--out", out, *more]

    def piped(self, argv, **variables):
        return subprocess.run(
            argv, capture_output=True, text=True, env=os.environ | variables, check=False
        )

    def test_every_study_has_a_line_that_is_never_wrapped_and_wiped_at_the_end(self):
        for program in STUDIES:
            if not os.path.exists(f"{BIN}/{program}"):
                continue
            with self.subTest(program):
                terminal = Terminal(self.argv(program, out=program))
                self.assertEqual(terminal.end(), 0)
                self.assertEqual(terminal.screen.faults, [])
                self.assertEqual(terminal.screen.lines, [])
                if program not in WITHOUT:
                    self.assertTrue(any("0:0" in line for line in terminal.screen.seen))

    def test_it_is_away_before_anything_else_is_written(self):
        for program in ("convergence", "exchange"):
            said = self.piped(self.argv(program, out="pipe")).stdout
            terminal = Terminal(self.argv(program), columns=200, shows_stdout=True)
            self.assertEqual(terminal.end(), 0)
            self.assertGreater(len(terminal.screen.seen), 1)
            self.assertEqual(terminal.screen.faults, [])
            self.assertEqual(terminal.screen.lines, [row for row in said.split("\n") if row])

    def test_none_says_nothing(self):
        terminal = Terminal(self.argv("work_precision", "--progress", "none"))
        self.assertEqual(terminal.end(), 0)
        self.assertEqual((terminal.screen.seen, terminal.screen.lines), (set(), []))

    def test_plain_lines_say_what_is_done(self):
        run = self.piped(self.argv("work_precision", "--progress", "plain"))
        self.assertEqual(run.returncode, 0)
        first = run.stderr.split("\n")[0]
        self.assertRegex(first, r"^work_precision 1/3  verlet is done  \d+:\d\d(, at most .*)?$")
        terminal = Terminal(self.argv("work_precision", "--progress=plain"), columns=200)
        self.assertEqual(terminal.end(), 0)
        self.assertIn("1/3  verlet is done", terminal.screen.lines[0])

    def test_a_pipe_gets_none_of_the_line(self):
        for variables in ({"TERM": "xterm"}, {"TERM": "dumb"}):
            run = self.piped(self.argv("work_precision"), **variables)
            self.assertEqual(run.returncode, 0)
            self.assertNotRegex(run.stderr, "[\r\x1b]")

    def test_a_dumb_terminal_is_none(self):
        for term in ("dumb", ""):
            terminal = Terminal(self.argv("work_precision"), TERM=term)
            self.assertEqual(terminal.end(), 0)
            self.assertEqual(terminal.screen.seen, set())

    def test_there_is_no_colour(self):
        for variables in ({}, {"NO_COLOR": "1"}, {"CLICOLOR_FORCE": "1"}):
            terminal = Terminal(self.argv("energy_drift", out="no_colour"), **variables)
            self.assertEqual(terminal.end(), 0)
            self.assertEqual(terminal.screen.faults, [])  # which any other escape sequence is

    def test_an_interruption_wipes_it(self):
        terminal = Terminal([f"{BIN}/work_precision", *LONG, "--out", "out"], columns=120)
        terminal.wait_for("1/")
        terminal.press(b"\x03")
        self.assertEqual(terminal.end(), 130)
        self.assertEqual(terminal.screen.faults, [])
        *echo, last = terminal.screen.lines
        self.assertRegex(last, "^(\\^C)?work_precision: interrupted by SIGINT; .*--resume")
        self.assertIn(echo, ([], ["^C"]))
        rest = self.piped(
            [f"{BIN}/work_precision", *LONG, "--out", "out", "--resume", "--progress", "none"]
            + ["--time-limit", "0.5"]
        )  # how it is said does not make it another study
        self.assertEqual(rest.returncode, 3)
        self.assertIn("pieces are kept from before", rest.stderr)

    def test_two_of_them_wipe_it_as_well(self):
        terminal = Terminal([f"{BIN}/work_precision", *LONG, "--out", "out"], columns=120)
        terminal.wait_for("1/")
        terminal.press(b"\x03\x03")
        self.assertIn(terminal.end(), (130, 128 + 2))
        for row in terminal.screen.lines:
            self.assertNotRegex(row, r"\d/\d")

    def test_a_time_limit_wipes_it(self):
        argv = [f"{BIN}/work_precision", *LONG, "--out", "out", "--time-limit", "1"]
        terminal = Terminal(argv, columns=120)
        self.assertEqual(terminal.end(), 3)
        self.assertRegex(" ".join(terminal.screen.lines), "^work_precision: interrupted by --time")
        self.assertEqual(len(terminal.screen.lines), 1)

    def test_what_was_measured_before_counts(self):
        self.test_an_interruption_wipes_it()
        argv = [f"{BIN}/work_precision", *LONG, "--out", "out", "--resume"]
        terminal = Terminal(argv, columns=120)
        terminal.wait_for("/")
        terminal.press(b"\x03")
        self.assertEqual(terminal.end(), 130)
        self.assertIn("pieces are kept from before", " ".join(terminal.screen.lines))

    def test_simulate_follows_its_run(self):
        run = [f"{BIN}/simulate", "--scene", "cloth", "--method", "verlet"]
        run += ["--step-size", "1e-5", "--until", "1e5"]
        terminal = Terminal(run)
        terminal.wait_for("t = ")
        terminal.press(b"\x03")
        self.assertEqual(terminal.end(), 130)
        self.assertEqual(terminal.screen.faults, [])
        self.assertRegex(
            re.sub(r"^\^C", "", terminal.screen.lines[-1]), "^simulate: interrupted by SIGINT"
        )
        self.assertTrue(any("left" in line for line in terminal.screen.seen))
        silent = self.piped([*run, "--progress", "none", "--time-limit", "2"])
        self.assertEqual(silent.returncode, 3)
        self.assertEqual(silent.stderr.count("\n"), 1)

    def test_another_word_is_refused(self):
        run = self.piped(self.argv("work_precision", "--progress", "loud"))
        self.assertEqual(run.returncode, 2)
        self.assertRegex(run.stderr, r"^work_precision: --progress loud .* auto, plain, none\n$")
        self.assertFalse(os.path.exists("out"))


if __name__ == "__main__":
    unittest.main()
