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
import json
import os
import shutil
import sys
import time

import code_state
import entries
from code_state import ROOT
from entries import read_studies, run
from kept_files import keep
from processor import processor


def draw(study):
    """Draws the results of a study and keeps the pictures."""
    if study.draws:
        for program in study.programs:
            run(study, f"experiments/{program}/{program}.py {os.path.relpath(study.folder, ROOT)}")
    for drawn, name in study.pictures.items():
        keep(study.folder / f"{drawn}.png", entries.PICTURES, f"{name}.png")


def begin(study, again):
    """Clears the folder of the study unless an interrupted run by the same sources left it; returns the
    seconds that this took so far. A program goes on with a journal of its own sources alone."""
    file = study.folder / "begun.json"
    sources = code_state.source_hash()
    begun = json.loads(file.read_text()) if file.exists() else {}
    if again or begun.get("sources") != sources or begun.get("commands") != study.commands:
        shutil.rmtree(study.folder, ignore_errors=True)
        begun = {"sources": sources, "commands": study.commands, "seconds": 0}
    study.folder.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(begun))
    return begun["seconds"]


def measure(study, again):
    """Runs the commands of a study; returns what they printed and the seconds that they took, those
    of runs that were interrupted included."""
    before = begin(study, again)
    start = time.time()
    try:
        printed = "".join(run(study, command) for command in study.commands)
    finally:
        seconds = before + time.time() - start
        file = study.folder / "begun.json"
        file.write_text(json.dumps({**json.loads(file.read_text()), "seconds": seconds}))
    return printed, seconds


def make(study, again):
    """Measures a study and keeps its tables, pictures and record."""
    for needed in (read_studies()[name] for name in study.needs):
        if not needed.folder.exists():
            make(needed, again=False)
    state = study.state
    printed, seconds = measure(study, again)
    data = entries.DATA / study.name
    if study.text:
        (study.folder / study.text).write_text(printed, encoding="utf-8")
        data.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(study.folder / study.text, data / study.text)
    draw(study)
    for pattern in study.tables:
        for table in sorted(study.folder.glob(pattern)):
            keep(table, data, columns=study.columns.get(table.name))
    date = datetime.date.today().isoformat()
    record = {**state, "date": date, "seconds": round(seconds, 1), **machine(study)}
    part = data / "study.json.part"
    part.parent.mkdir(parents=True, exist_ok=True)
    part.write_text(json.dumps(record, indent=1) + "\n")
    os.replace(part, part.with_suffix(""))
    (study.folder / "begun.json").unlink()


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
            names = code_state.changed(record["code"], study.programs)
            needs = record.get("needs", {})
            names += [
                name for name, value in study.state["needs"].items() if needs.get(name) != value
            ]
            print(f"{study.name}: older than {', '.join(names) or 'what its commands print'}")
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
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
