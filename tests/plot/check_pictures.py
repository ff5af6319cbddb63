"""Checks that each study's script draws the results of a small study: every picture exists, is not
empty and names the methods. The same numbers must give the same picture. The programs are in the
folder QDDOT_BIN."""

import re
import tempfile
import unittest
from pathlib import Path

from matplotlib import image

import studies
from programs import run
from study_tables import draw, draw_again, read_table, texts_of

# The pictures of each study, and the table whose column `method` the first of them must name.
PICTURES = {
    "work_precision": (("chart", "chart_energy"), "points.csv"),
    "stability_map": (("stability_map", "stability_modes"), "limits.csv"),
    "energy_drift": (("energy_drift",), "summary.csv"), "exchange": (("exchange",), None),
    "local_global": (("local_global",), None), "scaling": (("scaling",), "scaling.csv"),
    "crossover": (("crossover",), None), "modes": (("modes",), None),
    "symmetric_roots": (("symmetric_roots",), "roots.csv"), "advice": (("advice",), None),
    "bench": (("bench",), None), "equilibrium": (("equilibrium",), None),
}  # fmt: skip

# The width in pixels of a page's column, and the size of text that can still be read in it.
PAGE, READABLE = 830, 10
# The studies whose pictures are wider, and are to be opened at their full size.
WIDE = ("advice", "bench", "exchange", "local_global")


def ink(path):
    """The share of the picture's pixels that are not white."""
    return (image.imread(path)[..., :3].min(axis=-1) < 0.9).mean()


def words_of(study):
    """The options of a small study."""
    return studies.STUDIES.get(study, "--scene cloth")


def least_text(path):
    """The size in pixels of the smallest text of an SVG where the page shows it 830 pixels wide.
    Exponents, which matplotlib draws at 0.7 of their base, count as their base."""
    content = path.read_text(encoding="utf-8")
    width = float(re.search(r'width="([\d.]+)pt"', content)[1])
    sizes = {float(size) for size in re.findall(r"font(?:-size)?: (?:\w+ )*([\d.]+)px", content)}
    return min(size for size in sizes if size / 0.7 not in sizes) * PAGE / width


class Pictures(unittest.TestCase):
    """One test for each study, made below."""

    def check(self, study):
        """Runs the study and draws it twice."""
        pictures, table = PICTURES[study]
        folder = self.enterContext(tempfile.TemporaryDirectory())
        studies.write_scenes(folder)
        results = Path(folder) / "results"
        done = run(f"{study} {words_of(study)} --out results", cwd=folder)
        self.assertIn(done.returncode, (0, 3), done.stderr)
        self.assertEqual(draw(f"{study}/{study}.py", results), (0, ""))
        files = [results / f"{name}.{end}" for name in pictures for end in ("png", "svg")]
        first = [file.read_bytes() for file in files]
        for file in files[::2]:
            # Text and lines on white, or maps that fill their panels. An empty sheet has neither.
            self.assertTrue(0.01 < ink(file) < 0.8, f"{file.name}: {ink(file)}")
        for file in [] if study in WIDE else files[1::2]:
            self.assertGreater(least_text(file), READABLE, file.name)
        if table:
            methods = {row["method"] for row in read_table(results / table)}
            self.assertTrue(methods)
            words = " ".join(texts_of(files[1]))
            self.assertEqual([name for name in methods if name not in words], [])
        draw_again(f"{study}/{study}.py", results)
        self.assertEqual(first, [file.read_bytes() for file in files])


for name in PICTURES:
    setattr(Pictures, f"test_{name}", lambda self, study=name: self.check(study))
