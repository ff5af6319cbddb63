"""Measures what the pages of docs/ say, and keeps it in docs/data/ and docs/pictures/.

    ./run studies                  all that are not measured yet, or are older than the code
    ./run studies cloth bench      these alone
    ./run studies --again cloth    anew, whatever there is
    ./run studies --list           what there is, and how long each took
    ./run studies --check          which are older than the code; status 1 where one is
    ./run studies --draw           the pictures alone, of what lies in results/studies
    ./run studies --quick          those that say what programs print, where that has changed

docs/studies.toml lists them. Each runs in results/studies/NAME. A study that was interrupted goes on
where it was ended.
"""

import argparse
import datetime
import functools
import json
import os
import shlex
import shutil
import subprocess
import sys
import time
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import code_state
from code_state import ROOT
from kept_files import keep
from processor import processor

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
    needs: list = field(default_factory=list)  # studies whose results a script reads
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

    def is_fresh(self):
        """Whether the study was made by these commands and by the code as it is. A quick one is where
        its commands still print what is kept."""
        record = self.record
        if record and self.quick and all((BIN / program).exists() for program in self.programs):
            printed = "".join(run(self, command) for command in self.commands)
            return printed == (DATA / self.name / self.text).read_text(encoding="utf-8")
        return bool(
            record
            and record["commands"] == self.commands
            and not code_state.changed(record["code"], self.programs)
        )


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


def draw(study):
    """Draws the results of a study and keeps the pictures."""
    if study.draws:
        for program in study.programs:
            run(study, f"experiments/{program}/{program}.py {os.path.relpath(study.folder, ROOT)}")
    for drawn, name in study.pictures.items():
        keep(study.folder / f"{drawn}.png", PICTURES, f"{name}.png")


def make(study, again):
    """Measures a study and keeps its tables, pictures and record."""
    if again:
        shutil.rmtree(study.folder, ignore_errors=True)
    study.folder.mkdir(parents=True, exist_ok=True)
    code = code_state.state_of(study.programs)
    start = time.time()
    printed = "".join(run(study, command) for command in study.commands)
    seconds = time.time() - start
    if study.text:
        (study.folder / study.text).write_text(printed, encoding="utf-8")
    draw(study)
    for pattern in study.tables:
        for table in sorted(study.folder.glob(pattern)):
            keep(table, DATA / study.name, columns=study.columns.get(table.name))
    if study.text:
        (DATA / study.name).mkdir(parents=True, exist_ok=True)
        shutil.copyfile(study.folder / study.text, DATA / study.name / study.text)
    record = {
        "commands": study.commands,
        "code": code,
        "date": datetime.date.today().isoformat(),
        "seconds": round(seconds, 1),
        **machine(study),
    }
    part = DATA / study.name / "study.json.part"
    part.parent.mkdir(parents=True, exist_ok=True)
    part.write_text(json.dumps(record, indent=1) + "\n")
    os.replace(part, part.with_suffix(""))


def machine(study):
    """The processor, by the name that its vendor and generation have, and the compiler."""
    compiler = ""
    for file in sorted(study.folder.glob("*.json")):
        sidecar = json.loads(file.read_text())
        compiler = sidecar.get("compiler", compiler) if isinstance(sidecar, dict) else compiler
    return {"processor": processor(), "compiler": compiler}


def show(studies):
    """Prints one line a study: its age against the code, seconds and commands."""
    for study in studies.values():
        record = study.record
        state = "not measured" if not record else "fresh" if study.is_fresh() else "older"
        seconds = f"{record['seconds']:7.0f} s" if record else " " * 9
        print(f"{study.name:24}{state:14}{seconds}  {'; '.join(study.commands)}")


def check(studies):
    """Prints what is older than the code it describes, and by which folders; whether nothing is."""
    good = True
    for study in studies.values():
        if study.is_fresh():
            continue
        good = False
        record = study.record
        if not record:
            print(f"{study.name}: not measured")
        elif record["commands"] != study.commands:
            print(f"{study.name}: measured by another command: {'; '.join(record['commands'])}")
        else:
            folders = code_state.changed(record["code"], study.programs)
            print(f"{study.name}: older than {', '.join(folders)}")
    return good


def main():
    parser = argparse.ArgumentParser(
        prog="./run studies", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="studies of docs/studies.toml (default: all)")
    parser.add_argument("--again", action="store_true", help="measure anew what is measured")
    parser.add_argument("--list", action="store_true", help="say what there is")
    parser.add_argument("--draw", action="store_true", help="only draw the pictures anew")
    parser.add_argument("--quick", action="store_true", help="only what takes no time")
    parser.add_argument("--check", action="store_true", help="say what is older than the code")
    arguments = parser.parse_args()
    studies = read_studies()
    for name in arguments.names:
        if name not in studies:
            parser.error(f"there is no study '{name}'; ./run studies --list names them")
    chosen = {name: studies[name] for name in arguments.names or studies}
    if arguments.quick:
        chosen = {name: study for name, study in chosen.items() if study.quick}
    if arguments.list:
        show(chosen)
        return 0
    if arguments.check:
        return 0 if check(chosen) else 1
    if arguments.draw:
        for study in chosen.values():
            if study.pictures and study.folder.exists():
                draw(study)
        return 0
    for position, study in enumerate(chosen.values(), 1):
        if study.is_fresh() and not arguments.again:
            continue
        print(f"{position}/{len(chosen)} {study.name}: {'; '.join(study.commands)}", flush=True)
        make(study, arguments.again)
    return 0


if __name__ == "__main__":
    sys.exit(main())
