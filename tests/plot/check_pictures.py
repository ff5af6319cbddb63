#!/usr/bin/python3
"""Checks that each study's script draws the results of a small study: every picture exists, is not
empty and names the methods. The same numbers must give the same picture."""

import argparse
import csv
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

from matplotlib import image

import studies

EXPERIMENTS = Path(__file__).resolve().parents[2] / "experiments"

# The pictures of each study, and the table whose column `method` the first of them must name.
PICTURES = {
    "work_precision": (("chart", "chart_energy"), "points.csv"),
    "stability_map": (("stability_map", "stability_modes"), "limits.csv"),
    "energy_drift": (("energy_drift",), "summary.csv"),
    "exchange": (("exchange",), None),
    "local_global": (("local_global",), None),
    "scaling": (("scaling",), "scaling.csv"),
    "crossover": (("crossover",), None),
    "modes": (("modes",), None),
    "symmetric_roots": (("symmetric_roots",), "roots.csv"),
    "advice": (("advice",), None),
    "bench": (("bench",), None),
}


def run(*words, folder):
    """The command's end, with what it printed."""
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)


def draw(study, results):
    """Draws the results as ./run does."""
    environment = {**os.environ, "PYTHONPATH": str(EXPERIMENTS / "plot")}
    script = EXPERIMENTS / study / f"{study}.py"
    return subprocess.run(
        [sys.executable, "-B", script, results],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def ink(path):
    """The share of the picture's pixels that are not white."""
    pixels = image.imread(path)
    return (pixels[..., :3].min(axis=-1) < 0.9).mean()


def words_of(path):
    """All texts of an SVG picture."""
    return " ".join(text.strip() for text in ElementTree.parse(path).getroot().itertext())


class Pictures(unittest.TestCase):
    """One test for each study, made below."""

    bin = None

    def check(self, study):
        """Runs the study and draws it twice."""
        pictures, table = PICTURES[study]
        with tempfile.TemporaryDirectory() as folder:
            studies.write_scenes(folder)
            results = Path(folder) / "results"
            options = studies.STUDIES[study].split()
            done = run(self.bin / study, *options, "--out", str(results), folder=folder)
            self.assertIn(done.returncode, (0, 3), done.stderr)
            drawn = draw(study, results)
            self.assertEqual((drawn.returncode, drawn.stderr), (0, ""))
            files = [results / f"{name}.{end}" for name in pictures for end in ("png", "svg")]
            first = [file.read_bytes() for file in files]
            for file in files:
                if file.suffix == ".png":
                    # Text and lines on white, or maps that fill their panels. An empty sheet has
                    # neither.
                    self.assertTrue(0.01 < ink(file) < 0.8, f"{file.name}: {ink(file)}")
            if table:
                with open(results / table, newline="", encoding="utf-8") as rows:
                    methods = {row["method"] for row in csv.DictReader(rows)}
                self.assertTrue(methods)
                words = words_of(results / f"{pictures[0]}.svg")
                self.assertEqual([name for name in methods if name not in words], [])
            draw(study, results)
            self.assertEqual(first, [file.read_bytes() for file in files])


for name in PICTURES:
    setattr(Pictures, f"test_{name}", lambda self, study=name: self.check(study))

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=Path, required=True, help="the folder of the programs")
    arguments, others = parser.parse_known_args()
    Pictures.bin = arguments.bin.resolve()
    unittest.main(argv=[sys.argv[0], *others])
