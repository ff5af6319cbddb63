"""A test's folder of results, whose page is read as a browser does."""

import base64
import contextlib
import io
import json
import re
import tempfile
import unittest
import zlib
from html.parser import HTMLParser
from pathlib import Path

import numpy as np

import made_folder
import report
from study_tables import judge, read_table, write_table


class Elements(HTMLParser):
    """All elements of a page with their attributes and texts."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.found, self.open = [], []

    def handle_starttag(self, tag, attrs):
        self.found.append([tag, dict(attrs), ""])
        self.open.append(self.found[-1])

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        if self.open:
            self.open[-1][2] += data


def elements(text):
    """The elements of a page as lists of tag, attributes and text."""
    parser = Elements()
    parser.feed(text)
    parser.close()
    return parser.found


def refuse(word):
    """JSON in a page has no such number."""
    raise ValueError(f"the JSON has the number {word}")


class Page:
    """A page's JSON as `data` and its blobs, inflated."""

    def __init__(self, path):
        self.text = path.read_text(encoding="utf-8")
        scripts = re.findall(r'<script type="([^"]*)" id="([^"]*)">(.*?)</script>', self.text, re.S)
        texts = {name: (kind, text) for kind, name, text in scripts}
        kind, self.json = texts.pop("report")
        assert kind == "application/json"
        self.data = json.loads(self.json, parse_constant=refuse)
        self.blobs = {
            name: zlib.decompress(base64.b64decode(text, validate=True), -15)
            for name, (kind, text) in texts.items()
            if kind == "text/plain"
        }

    def positions(self, run):
        """The positions (frames, nodes, 3) of a run in m, by changes of 16-bit steps."""
        data = np.frombuffer(self.blobs[run["positions"]], np.uint8).astype(np.uint32)
        half = len(data) // 2
        changes = (data[:half] + 256 * data[half:]).reshape(len(run["times"]), -1, 3)
        motion, steps = self.data["motion"], np.cumsum(changes, axis=0) % 65536
        return np.array(motion["low"]) + motion["size"] * steps / 65535

    def distances(self, run):
        """The relative distances (frames, nodes) of a run that its codes stand for."""
        codes = np.frombuffer(self.blobs[run["distances"]], np.uint8).astype(float)
        values = np.where(codes == 0, 0, 10 ** ((codes - 1) * 14 / 254 - 14))
        return values.reshape(len(run["times"]), -1)


def pack(folder):
    """The packer's exit status and what it says on stderr."""
    with contextlib.redirect_stderr(io.StringIO()) as said:
        status = report.main([str(folder)])
    return status, said.getvalue()


def edit_json(path, change):
    """Changes a JSON file's content."""
    content = json.loads(path.read_text())
    change(content)
    path.write_text(json.dumps(content))


class Folder(unittest.TestCase):
    """A folder of results and its page."""

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory())) / "results"

    def make(self, **options):
        """Makes the folder and its page."""
        made_folder.make_folder(self.folder, **options)
        return self.page()

    def page(self):
        """The page of the folder as it is now, its record made anew."""
        judge(self.folder)
        return self.packed()

    def data_of(self, rows):
        """The data of the page with these points."""
        self.rewrite("points.csv", rows)
        return self.page().data

    def packed(self):
        """The page of the folder with the record that it has."""
        self.assertEqual(pack(self.folder), (0, ""))
        return Page(self.folder / "report.html")

    def edit(self, name, change):
        """Changes a JSON file's content."""
        edit_json(self.folder / name, change)

    def rows(self, name="points.csv"):
        """The rows of a table."""
        return read_table(self.folder / name)

    def rewrite(self, name, rows):
        """Writes a table anew."""
        write_table(self.folder / name, rows)
