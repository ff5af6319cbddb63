"""The studies of docs/studies.toml: what each runs, what docs/data keeps of it, and when it is to be
measured again.

A study is to be measured where it never was, or where its commands, the scene files in them, or a
study that it needs have changed. Code that has changed since makes no study due: git says how many
commits changed it, and who measures judges whether they can change a number.
"""

import csv
import dataclasses
import functools
import hashlib
import io
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from page_data import DATA, ROOT, SECOND

PICTURES = ROOT / "docs/pictures"
# The folders in which studies are measured for docs/data, and repeated beside it.
MEASURED, REPEATED = "results/studies", "results/repeated"
ON_SECOND = "results/second"  # for docs/data, on a second processor
BIN = Path(os.environ.get("QDDOT_BIN", ROOT / "build/bin"))
PYTHON_PATH = ("experiments/plot", "experiments/sweep", "build/python")
# Left out of sidecars: states of all nodes, and the command with the folders of the machine.
UNKEPT = ("q", "v", "modal_shares", "command_line", "key")


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
    quick: bool = False  # whether it takes no time, so that its text is compared each time
    room: str = ""  # the folder of the project in which its own lies; MEASURED by default
    place: str = ""  # of its tables, in its folder of docs/data

    @property
    def folder(self):
        return ROOT / (self.room or MEASURED) / self.name

    def repeat(self):
        """The same study in another folder, so that the one which docs/data was made of stays."""
        commands = [line.replace(MEASURED + "/", REPEATED + "/") for line in self.commands]
        return dataclasses.replace(self, commands=commands, room=REPEATED)

    def on_second(self):
        """The same study for the pages' second column, without pictures."""
        commands = [line.replace(MEASURED + "/", ON_SECOND + "/") for line in self.commands]
        return dataclasses.replace(
            self, commands=commands, room=ON_SECOND, place=SECOND, pictures={}, draws=False
        )

    @property
    def is_complete(self):
        """Whether its folder has all that it measures."""
        return self.folder.exists() and not (self.folder / "begun.json").exists()

    @property
    def data(self):
        return DATA / self.name / self.place

    @property
    def programs(self):
        """The programs that the study runs; of a script its folder's name."""
        words = [shlex.split(command)[0] for command in self.commands]
        return sorted({Path(word).parts[1] if "/" in word else word for word in words})

    @property
    def record(self):
        """How the study was measured, from docs/data; None where it never was."""
        file = self.data / "study.json"
        return json.loads(file.read_text()) if file.exists() else None

    @property
    def inputs(self):
        """What decides, beside code, what the study measures; part of its record."""
        words = {word for command in self.commands for word in shlex.split(command)}
        scenes = sorted(word for word in words if word.endswith(".toml"))
        needs = {scene: digest(ROOT / scene) for scene in scenes}
        needs |= {name: digest(DATA / name / "study.json") for name in self.needs}
        return {"commands": self.commands, "needs": needs}

    def due(self):
        """Why the study is to be measured, as words; empty where it need not be."""
        record = self.record
        if not record:
            return "not measured"
        if self.quick and all((BIN / program).exists() for program in self.programs):
            same = self.printed() == (self.data / self.text).read_text(encoding="utf-8")
            return "" if same else "prints another text"
        if record["commands"] != self.commands:
            return f"measured by another command: {'; '.join(record['commands'])}"
        now, then = self.inputs["needs"], record["needs"]
        changed = sorted(name for name in {*now, *then} if now.get(name) != then.get(name))
        return f"changed since: {', '.join(changed)}" if changed else ""

    def commits_since(self):
        """How many commits after the one that measured the study changed the library, the methods
        or its programs; None where git cannot say."""
        measured_by = re.search(r"\((\S+?)(-dirty)?\)", self.record["version"])
        return commits_after(measured_by[1], *self.programs) if measured_by else None

    def printed(self):
        """Runs the commands; returns what they printed."""
        return "".join(run(self, command) for command in self.commands)


def read_studies():
    """All studies by name, in the order of docs/studies.toml."""
    with open(ROOT / "docs/studies.toml", "rb") as file:
        return {name: Study(name, **entry) for name, entry in tomllib.load(file).items()}


def digest(file):
    """The hash of a file; empty where there is none."""
    return hashlib.sha256(file.read_bytes()).hexdigest()[:16] if file.exists() else ""


@functools.cache
def commits_after(commit, *programs):
    """The number of commits after this one that changed what these programs are made of; None where
    git cannot say."""
    if not shutil.which("git"):
        return None
    own = [f"experiments/{program}" for program in programs]
    own += ["tests/fuzz", "tests/independent"] * any(p.startswith("fuzz_") for p in programs)
    count = subprocess.run(
        ["git", "rev-list", "--count", f"{commit}..HEAD", "--", "src", "integrators", *own],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    return int(count.stdout) if count.returncode == 0 else None


@functools.cache
def source_hash():
    """The hash of all sources, as sidecars and journals have it (experiments/kit/build_info.cmake)."""
    rooms = ("src", "integrators", "experiments")
    files = sorted(file for room in rooms for file in (ROOT / room).rglob("*.[ch]pp"))
    lines = (
        f"{file.relative_to(ROOT).as_posix()} {hashlib.sha256(file.read_bytes()).hexdigest()}\n"
        for file in files
    )
    return hashlib.sha256("".join(lines).encode()).hexdigest()


@functools.cache
def help_of(program):
    return subprocess.run(
        [BIN / program, "--help"], capture_output=True, text=True, check=True
    ).stdout


def run(study, command):
    """Runs one command of a study from the project's root; returns what it printed. Ends the process
    where it fails. Status 3 is none of that: some runs fell short, which the tables say."""
    first, *rest = shlex.split(command)
    if first.endswith(".py"):
        call = ["/usr/bin/python3", "-B", first, *rest]
    else:
        call = [str(BIN / first), *rest]
        if not study.text and first != "sweep":
            call += ["--out", os.path.relpath(study.folder, ROOT)]
            call += ["--resume"] * ("--resume" in help_of(first))
    environment = dict(os.environ, LC_ALL="C", OPENBLAS_NUM_THREADS="1")
    environment["PYTHONPATH"] = ":".join(str(ROOT / path) for path in PYTHON_PATH)
    environment.setdefault("OMP_NUM_THREADS", "1")
    done = subprocess.run(
        call, cwd=ROOT, env=environment, text=True, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT if study.text else None, check=False,
    )  # fmt: skip
    if done.returncode not in (0, 3):
        sys.exit(f"studies: {study.name}: status {done.returncode} of {shlex.join(call)}")
    return done.stdout


def write_whole(file, content):
    """Writes a file of text or bytes whole or not at all."""
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(file.name + ".part")
    part.write_bytes(content.encode() if isinstance(content, str) else content)
    os.replace(part, file)


def rounded(cell):
    """A number of a table in the six digits that pages can need; anything else as it is."""
    try:
        return f"{float(cell):.6g}"
    except ValueError:
        return cell


def keep(file, target, columns=None):
    """Copies a result, whole or not at all. A table keeps these columns, or all. A chart's record
    keeps the errors that judge accuracy. Numbers of both are kept in six digits."""
    if file.suffix == ".csv":
        with open(file, newline="", encoding="utf-8") as source:
            rows = list(csv.DictReader(source))
        names = columns or list(rows[0])
        lines = [names] + [[rounded(row[name]) for name in names] for row in rows]
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(lines)
        write_whole(target, text.getvalue())
    elif file.suffix == ".json":
        is_chart = file.name == "chart.json"
        style = {"separators": (",", ":")} if is_chart else {"indent": 1}
        number = (lambda digits: float(rounded(digits))) if is_chart else float
        facts = json.loads(file.read_text(encoding="utf-8"), parse_float=number)
        kept = {key: value for key, value in facts.items() if key not in UNKEPT}
        if is_chart:
            judge = kept["judged_by"]
            kept["quantities"] = [one for one in kept["quantities"] if one["name"] == judge]
        write_whole(target, json.dumps(kept, **style) + "\n")
    else:
        write_whole(target, file.read_bytes())
