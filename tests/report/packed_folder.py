"""A test's folder of results, whose page is made with a trivial template."""

import contextlib
import csv
import io
import json
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import made_folder
import page
import report
from decoding import Page
from made_sweeps import judge

TEMPLATE = (
    "<!DOCTYPE html><html><head><title>{{title}}</title><!-- qddot:style --></head><body>"
    "<h1>{{title}}</h1><noscript><!-- qddot:static --></noscript>"
    "<!-- qddot:data --><!-- qddot:scripts --></body></html>\n"
)


class Folder(unittest.TestCase):
    """A folder of results, and a trivial page in the place of the real one."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.home = Path(temporary.name) / "home"
        (self.home / "page").mkdir(parents=True)
        (self.home / "page/page.html").write_text(TEMPLATE)
        (self.home / "page/a.js").write_text("start('<!' + '-- qddot:data -->');")
        (self.home / "page/a.css").write_text("p { color: red; }")
        own = {"HOME": self.home, "STYLES": ["page/a.css"], "SCRIPTS": ["page/a.js"]}
        patch = mock.patch.multiple(page, **own)
        patch.start()
        self.addCleanup(patch.stop)
        self.folder = Path(temporary.name) / "results"

    def make(self, **options):
        """Makes the folder and its page."""
        made_folder.make_folder(self.folder, **options)
        return self.page()

    def call(self):
        """The packer's exit status and what it says on stderr."""
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            status = report.main([str(self.folder)])
        return status, said.getvalue()

    def page(self):
        """The page of the folder as it is now, its record made anew."""
        judge(self.folder)
        return self.packed()

    def packed(self):
        """The page of the folder with the record that it has."""
        self.assertEqual(self.call(), (0, ""))
        return Page(self.folder / "report.html")

    def edit(self, name, change):
        """Changes a JSON file's content."""
        path = self.folder / name
        content = json.loads(path.read_text())
        change(content)
        path.write_text(json.dumps(content))

    def rows(self, name="points.csv"):
        """The rows of a table."""
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def rewrite(self, name, rows):
        """Writes a table anew."""
        with open(self.folder / name, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
