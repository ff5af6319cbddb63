"""Runs of the programs, each in a fresh folder, and the tables that they write.

The programs are in the folder QDDOT_BIN.
"""

import atexit
import csv
import functools
import io
import json
import math
import os
import shlex
import signal
import subprocess
import tempfile
import time
import unittest

# A shell ignores SIGINT for what it starts aside; programs would go on to ignore it.
signal.signal(signal.SIGINT, signal.default_int_handler)

BIN = os.path.abspath(os.environ.get("QDDOT_BIN", "build/bin"))

# A motion that nobody can follow to its end.
CHAOS = 'until = 12\n[generator]\nkind = "chain"\nnodes = 4\nstiffness = 1000\n'


def read(path):
    """The text of a file, line ends as they are."""
    with open(path, newline="", encoding="utf-8") as file:
        return file.read()


def write(path, text):
    """Writes a file; returns its path."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def node(*position, **more):
    return {"position": list(position), **more}


def pin(*position, **more):
    return node(*position, pinned=True, **more)


def spring(i, j, stiffness, **more):
    return {"nodes": [i, j], "stiffness": stiffness, **more}


def toml(value):
    """A value in TOML, tables and lists on one line each."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def scene(nodes, springs=(), **more):
    """A scene file's text."""
    tables = {"dimension": len(nodes[0]["position"]), **more}
    tables |= {"nodes": nodes, "springs": list(springs)}
    return "".join(f"{key} = {toml(value)}\n" for key, value in tables.items())


def value_of(field):
    """A table's field: None where it is empty, a number where it is one, its text elsewhere."""
    try:
        value = float(field)
    except ValueError:
        return field or None
    if not math.isfinite(value):
        raise ValueError(f"a table has the number {field}")
    return value


def rows_of(text):
    """The rows of an RFC 4180 table, each by column; raises where it is none."""
    names, *rows = csv.reader(io.StringIO(text, newline=""), strict=True)
    if not text.endswith("\n") or any(len(row) != len(names) for row in rows):
        raise ValueError("a line is too short or too long")
    return [dict(zip(names, map(value_of, row))) for row in rows]


def table(path, columns=None):
    """The rows of a table; `columns`: its header as it must be."""
    assert columns in (None, header(path)), f"{path}: {header(path)}"
    return rows_of(read(path))


def header(path):
    return read(path).split("\n", 1)[0]


def sidecar(path):
    return json.loads(read(path))


def words_of(line):
    """The words of a command line, the program's path first."""
    program, *words = shlex.split(line) if isinstance(line, str) else line
    return [f"{BIN}/{program}", *words]


def run(line, **more):
    """Runs a command line here, to its end, which comes within five minutes."""
    return subprocess.run(
        words_of(line), capture_output=True, text=True, check=False, timeout=300, **more
    )


def started(line):
    """The process of a command line that goes on."""
    pipe = subprocess.PIPE
    return subprocess.Popen(words_of(line), stdout=pipe, stderr=pipe, text=True)


def wait(is_so):
    """Waits until something is so, at most two minutes."""
    for _ in range(12000):
        if is_so():
            return
        time.sleep(0.01)
    raise AssertionError("it did not come in two minutes")


class Study:
    """The words and files of a command line, in a folder that lasts to the end of all tests."""

    def __init__(self, line, files=()):
        folder = tempfile.TemporaryDirectory()
        atexit.register(folder.cleanup)
        self.path = folder.name
        for name, text in files:
            write(f"{self.path}/{name}", text)
        self.run = run(line, cwd=self.path)
        if self.run.returncode != 0:
            raise AssertionError(f"{line}: status {self.run.returncode}: {self.run.stderr}")
        self.out, self.err = self.run.stdout, self.run.stderr

    def __truediv__(self, name):
        return os.path.join(self.path, name)

    def table(self, name, columns=None):
        return table(self / name, columns)

    def sidecar(self, name):
        return sidecar(self / name)


@functools.cache
def study(line, *files):
    """The command line's study, made once; `files`: pairs of a name and a text."""
    return Study(line, files)


class Programs(unittest.TestCase):
    """Each test has a fresh folder, in which it stands."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def holds(self, text, *fragments):
        for fragment in fragments:
            self.assertIn(fragment, text)

    def near(self, a, b, tolerance):
        self.assertLessEqual(abs(a - b), tolerance, f"{a} and {b}")

    def done(self, line):
        """Runs a command line that has to end well."""
        ended = run(line)
        self.assertEqual(ended.returncode, 0, f"{line}: {ended.stderr}")
        return ended

    def complains(self, line, status, *fragments):
        """Checks that the command line (or its run) ends with the status and one sentence of the
        program that holds the fragments."""
        ended = line if isinstance(line, subprocess.CompletedProcess) else run(line)
        program = os.path.basename(ended.args[0])
        self.assertEqual(ended.returncode, status, f"{line}: {ended.stderr}")
        self.assertRegex(ended.stderr, rf"\A{program}: [^\n]*\n\Z")
        self.holds(ended.stderr, *fragments)
        return ended

    def refused(self, line, *fragments):
        """Checks that the command line is refused in a sentence, and writes and prints no more."""
        with self.subTest(line):
            before = list(os.walk("."))
            ended = self.complains(line, 2, *fragments)
            self.assertEqual((ended.stdout, list(os.walk("."))), ("", before))

    def signalled(self, process, signal):
        """How a process ended after the signal."""
        process.send_signal(signal)
        out, err = process.communicate()
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)
