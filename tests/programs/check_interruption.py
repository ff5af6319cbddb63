"""Runs and studies that are interrupted or killed: what they reached is there, and they go on."""

import glob
import os
import signal
import time
from pathlib import Path

from programs import Programs, sidecar, started, table, wait, write

# A run that is long, into long.csv.
LONG = (
    "simulate --scene oscillator --method verlet --step-size 1e-9 --until 1e3 --final long.csv"
)
SHORT = "simulate --scene oscillator --method verlet --step-size 0.01 --until 1 --final "
STUDY = (
    "work_precision --scene pendulum --methods verlet,rk4,blanes_moan4,ida,trapezoidal,bdf2,hht"
    " --accuracies 1e-5 --repeats 3 --until 20 --out ended"
)


def wait_for(pattern, text=b""):
    """Waits until there is a file of such a name that holds the text."""
    wait(lambda: any(text in Path(path).read_bytes() for path in glob.glob(pattern)))


class Interruption(Programs):
    def test_signals_end_a_run_with_what_it_reached(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = started(LONG + " --force")
            wait_for("long.json.*part")
            time.sleep(0.1)
            ended = self.signalled(process, number)
            self.complains(ended, 130, "interrupted", number.name, "of 1000 s reached")
            self.assertEqual(sorted(os.listdir(".")), ["long.csv", "long.json"])
            self.assertEqual(len(table("long.csv")), 2)
            self.assertEqual(sidecar("long.json")["interrupted"], number.name)
            self.assertLess(sidecar("long.json")["t_reached"], 1e3)

    def test_a_time_limit_ends_a_run_in_order(self):
        self.complains(LONG + " --time-limit 0.3", 3, "--time-limit", "reached")
        self.assertEqual(sidecar("long.json")["interrupted"], "--time-limit")
        self.done(SHORT + "a.csv --time-limit 1e9")  # which ends by itself
        self.assertIsNone(sidecar("a.json")["interrupted"])

    def test_a_study_that_is_interrupted_has_its_tables_and_goes_on(self):
        process = started(STUDY)
        # A study whose journal has no piece yet has nothing to save.
        wait_for("ended/work_precision.journal", b"outcome")
        ended = self.signalled(process, signal.SIGINT)
        self.complains(ended, 130, "interrupted by SIGINT", "--resume")
        before = len(table("ended/points.csv"))
        self.assertEqual(sidecar("ended/points.json")["interrupted"], "SIGINT")
        self.done(STUDY + " --resume")
        self.assertIsNone(sidecar("ended/points.json")["interrupted"])
        self.assertGreaterEqual(len(table("ended/points.csv")), before)
        self.assertIn("nothing is missing", self.done(STUDY + " --resume").stderr)

    def test_the_study_that_pages_show_goes_on(self):
        # Two million steps take longer than the limit on any machine.
        line = "reversal --scene pendulum --until 1 --methods verlet,rk4 --steps 1e-6 --out ."
        self.complains(line + " --time-limit 0.02", 3, "interrupted by --time-limit")
        self.done(line + " --resume")
        self.assertEqual(len(table("reversal.csv")), 2)
        self.assertIn("nothing is missing", self.done(line + " --resume").stderr)

    def test_unfinished_files_of_the_dead_go_and_those_of_the_living_stay(self):
        for name in ("a.csv.999999.part", "a.csv.part", "notes.part"):
            write(name, "the user's, or half")
        living = started(LONG)
        wait_for("long.json.*part")
        self.done(SHORT + "b.csv")
        there = os.listdir(".")
        self.assertNotIn("a.csv.999999.part", there)
        self.assertLessEqual({"a.csv.part", "notes.part"}, set(there))
        self.assertTrue(glob.glob("long.csv.*"), there)
        self.assertEqual(self.signalled(living, signal.SIGTERM).returncode, 130)
        left = "a.csv.part b.csv b.json long.csv long.json notes.part"
        self.assertEqual(sorted(os.listdir(".")), left.split())
