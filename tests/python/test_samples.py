"""The code that pages and the notebook show does what it says."""

import contextlib
import io
import json
import os
import re
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

import qddot

ROOT = Path(__file__).resolve().parents[2]


def blocks_of(page):
    """The blocks of Python in a page of Markdown."""
    return re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)


class Samples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        qddot.scenes.cloth(nodes=5).save("cloth.toml")
        os.environ["MPLBACKEND"] = "Agg"

    def run_all(self, codes, **names):
        self.assertTrue(codes)
        names["__name__"] = "sample"
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
        nodes = np.column_stack((np.arange(30) * 0.1, np.zeros(30), np.zeros(30)))
        springs = [(i, i + 1) for i in range(29)]
        names, _ = self.run_all(blocks_of("docs/python.md"), X=nodes, E=springs)
        self.assertEqual(names["sol"].q.shape, (61, 30, 3))
        self.assertLess(names["sure"].error_estimate, 1e-4)
        self.assertLess(names["chart"].best(1e-4).error_position, 1e-4)

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


if __name__ == "__main__":
    unittest.main()
