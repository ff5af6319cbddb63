"""Reads a report page as a browser does: its JSON and its blobs, by the format's own words."""

import base64
import json
import re
import zlib
from html.parser import HTMLParser

import numpy as np


class Elements(HTMLParser):
    """All elements of a page with their attributes and texts, and its comments."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.found = []
        self.open = []
        self.comments = []

    def handle_starttag(self, tag, attrs):
        self.found.append([tag, dict(attrs), ""])
        self.open.append(self.found[-1])

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        if self.open:
            self.open[-1][2] += data

    def handle_comment(self, data):
        self.comments.append(data)


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
        kind, text = texts.pop("report")
        assert kind == "application/json"
        self.json = text
        self.data = json.loads(text, parse_constant=refuse)
        self.blobs = {
            name: zlib.decompress(base64.b64decode(text, validate=True), -15)
            for name, (kind, text) in texts.items()
            if kind == "text/plain"
        }

    def steps(self, run):
        """The 16-bit positions (frames, nodes, 3) of a run of the motion."""
        data = np.frombuffer(self.blobs[run["positions"]], np.uint8).astype(np.uint32)
        half = len(data) // 2
        changes = (data[:half] + 256 * data[half:]).reshape(len(run["times"]), -1, 3)
        return np.cumsum(changes, axis=0) % 65536

    def positions(self, run):
        """The positions (frames, nodes, 3) of a run in m."""
        motion = self.data["motion"]
        return np.array(motion["low"]) + motion["size"] * self.steps(run) / 65535

    def distances(self, run):
        """The relative distances (frames, nodes) of a run that its codes stand for."""
        codes = np.frombuffer(self.blobs[run["distances"]], np.uint8).astype(float)
        values = np.where(codes == 0, 0, 10 ** ((codes - 1) * 14 / 254 - 14))
        return values.reshape(len(run["times"]), -1)
