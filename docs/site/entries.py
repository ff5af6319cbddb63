"""The entries of docs/studies.toml: what each runs, where its results lie, and whether they are as old as
the code."""

import functools
import hashlib
import json
import os
import shlex
import subprocess
import sys
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import code_state
from code_state import ROOT

DATA, PICTURES, RESULTS = ROOT / "docs/data", ROOT / "docs/pictures", ROOT / "results/studies"
BIN = Path(os.environ.get("QDDOT_BIN", ROOT / "build/bin"))
PYTHON_PATH = ("experiments/plot", "experiments/sweep", "build/python")


@dataclass
class Study:
    """One entry of docs/studies.toml."""

    name: str
    commands: list  # what to run, in order
    tables: list = field(default_factory=list)  # patterns of its files that pages read
    pictures: dict = field(default_factory=dict)  # the name in docs/pictures of a drawn one
    text: str = ""  # the file that takes what the commands print; such commands take no --out
    draws: bool = False  # whether experiments/PROGRAM/PROGRAM.py is to draw
    needs: list = field(default_factory=list)  # studies whose results it reads
    columns: dict = field(default_factory=dict)  # of a large table, those that pages read
    quick: bool = False  # whether it takes no time, so that it is looked at each time

    @property
    def folder(self):
        return RESULTS / self.name

    @property
    def programs(self):
        """The programs whose code the study depends on; of a script its folder's."""
        words = [shlex.split(command)[0] for command in self.commands]
        return sorted({Path(word).parts[1] if "/" in word else word for word in words})

    @property
    def record(self):
        """What docs/data keeps of how the study was made; None where it never was."""
        file = DATA / self.name / "study.json"
        return json.loads(file.read_text()) if file.exists() else None

    @property
    def state(self):
        """What the study is made by: commands, code, and the records of the studies that it needs."""
        return {
            "commands": self.commands,
            "code": code_state.state_of(self.programs),
            "needs": {name: digest(DATA / name / "study.json") for name in self.needs},
        }

    def is_fresh(self):
        """Whether the study was made by what there is now. A quick one is where its commands still
        print what is kept."""
        record = self.record
        if record and self.quick and all((BIN / program).exists() for program in self.programs):
            printed = "".join(run(self, command) for command in self.commands)
            return printed == (DATA / self.name / self.text).read_text(encoding="utf-8")
        return bool(record) and all(record.get(key) == now for key, now in self.state.items())


def digest(file):
    """The hash of a file; empty where there is none."""
    return hashlib.sha256(file.read_bytes()).hexdigest()[:16] if file.exists() else ""


def read_studies():
    """All studies by name, in the order of docs/studies.toml."""
    with open(ROOT / "docs/studies.toml", "rb") as file:
        entries = tomllib.load(file)
    return {name: Study(name, **entry) for name, entry in entries.items()}


@functools.cache
def takes_resume(program):
    """Whether a program can go on with an interrupted study."""
    shown = subprocess.run([BIN / program, "--help"], capture_output=True, text=True, check=True)
    return "--resume" in shown.stdout


def call_of(study, command):
    """The words to run: a program of build/bin, or a Python script of the project."""
    first, *rest = shlex.split(command)
    if first.endswith(".py"):
        return ["/usr/bin/python3", "-B", first, *rest]
    call = [str(BIN / first), *rest]
    if not study.text and first != "sweep":
        call += ["--out", os.path.relpath(study.folder, ROOT)]
        if takes_resume(first):
            call.append("--resume")
    return call


def run(study, command):
    """Runs one command of a study from the project's root; returns what it printed. Ends the process
    where it fails. Status 3 is none of that: some runs fell short, which the tables say."""
    environment = dict(os.environ, LC_ALL="C", OPENBLAS_NUM_THREADS="1")
    environment["PYTHONPATH"] = ":".join(str(ROOT / path) for path in PYTHON_PATH)
    environment.setdefault("OMP_NUM_THREADS", "1")
    call = call_of(study, command)
    done = subprocess.run(
        call, cwd=ROOT, env=environment, text=True, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT if study.text else None, check=False,
    )  # fmt: skip
    if done.returncode not in (0, 3):
        sys.exit(f"studies: {study.name}: status {done.returncode} of {shlex.join(call)}")
    return done.stdout
