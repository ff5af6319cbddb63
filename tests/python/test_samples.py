"""The code that pages and the notebook show does what it says."""

import contextlib
import io
import json
import os
import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import qddot
from programs import Programs, table

ROOT = Path(__file__).resolve().parents[2]


def blocks_of(page):
    """The blocks of Python in a page of Markdown."""
    return re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)


class Samples(Programs):
    def setUp(self):
        super().setUp()
        qddot.scenes.cloth(nodes=5).save("cloth.toml")
        os.environ["MPLBACKEND"] = "Agg"

    def run_all(self, codes):
        self.assertTrue(codes)
        names = {"__name__": "sample"}
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()) as out:
            warnings.simplefilter("ignore")
            with contextlib.redirect_stderr(io.StringIO()):
                for code in codes:
                    exec(compile(code, "sample", "exec"), names)
        return names, out.getvalue()

    def test_readme(self):
        names, _ = self.run_all(blocks_of("README.md"))
        self.assertTrue(names["sol"].success and names["sure"].success)
        self.assertEqual(names["sol"].q.shape, (61, 900, 3))

    def test_page(self):
        names, _ = self.run_all(blocks_of("docs/python.md"))
        self.assertEqual(names["sol"].q.shape, (61, 30, 3))
        self.assertLess(names["sure"].error_estimate, 1e-4)
        self.assertLess(names["chart"].best(1e-4).error_position, 1e-4)

    def test_lecture(self):
        names, _ = self.run_all(blocks_of("docs/lecture.md"))
        # Differences of a step d leave d^2 and rounding over d.
        self.assertLess(abs(names["stiffness"](names["q"]) - names["columns"]).max(), 1e-7)
        self.assertLess(abs(names["force"](names["q"]).ravel() + names["slope"]).max(), 1e-7)
        action, e = names["action"], names["e"]
        # The second derivative is the integral of m b'^2 - m w^2 b^2 over the change b.
        second = np.pi**2 / (2 * names["until"]) - 100 * names["until"] / 2
        self.assertLess(abs(action(e) - action(-e)) / (2 * e), 1e-5)  # sums in steps of 1e-4 s
        bent = (action(e) - 2 * action(0) + action(-e)) / e**2
        self.assertLess(abs(bent - second), 1e-4 * abs(second))
        end = names["end"]
        exact = [end.q[1, 0], end.v[1, 0]]
        self.assertLess(abs(names["flow"] @ [1.0, 0.0] - exact).max(), 1e-12)
        self.assertEqual(names["bent"].outcome, "reached")
        sunk = (names["beam"].positions - names["bent"].positions)[:, 2]
        self.assertGreater(sunk.max(), 0.01)  # the free end, by more than a line's width
        self.assertGreater(os.path.getsize("bent.png"), 5000)

    def test_notebook(self):
        path = ROOT / "examples/notebook/first_steps.ipynb"
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        codes = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        names, out = self.run_all(codes)
        self.assertIn("unknowns", out)
        self.assertEqual(names["failed"].outcome, "diverged")
        for cell in cells:
            for output in cell.get("outputs", []):
                self.assertNotEqual(output["output_type"], "error")


class BesideSciPy(Programs):
    def test_a_small_study_is_measured_and_drawn(self):
        study = ROOT / "experiments/beside_scipy"
        words = "--problems planet --point-limit 0.01 --reference-seconds 2 --repeats 1 --out .".split()
        command = [sys.executable, "-B", study / "measure.py", *words]
        done = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        runs = table("runs.csv")
        ways = {(run["force"], run["way"]) for run in runs}
        self.assertLessEqual({("own f", "solve_ivp"), ("own f", "qddot")}, ways)
        self.assertTrue(all(0 < run["error_position"] <= 3 for run in runs))
        done = subprocess.run(
            [sys.executable, "-B", study / "beside_scipy.py", "."],
            env={**os.environ, "PYTHONPATH": str(ROOT / "experiments/plot")},
            capture_output=True, text=True,
        )  # fmt: skip
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(os.path.getsize("beside_scipy.png"), 10_000)
