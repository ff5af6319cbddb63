"""Measures what the pages of docs/ say, and keeps it in docs/data/ and docs/pictures/.

    ./run studies                  all that are not measured yet, or whose commands, scene files or
                                   needed studies have changed
    ./run studies cloth bench      these alone. One that need not be measured is repeated beside what
                                   docs/data keeps: in results/repeated/NAME, and each figure is
                                   printed then and now
    ./run studies --again cloth    these from the start, interrupted or not, for docs/data
    ./run studies --second bench   these for the pages' second column, on another processor than
                                   docs/data's; --again as above
    ./run studies --list           what there is, and how long each took
    ./run studies --check          which are to be measured (status 1 where one is), and how many
                                   commits changed the code of the others since
    ./run studies --draw           the pictures alone, of what lies in results/studies
    ./run studies --quick          those that say what programs print, where that has changed

docs/studies.toml lists them. Each runs in results/studies/NAME. A study that was interrupted goes on
where it was ended.
"""

import argparse
import datetime
import json
import os
import re
import shutil
import subprocess
import sys
import time

import study as entries
from processor import processor
from repeated import comparison
from study import BIN, ROOT, keep, read_studies, run, source_hash, write_whole


def draw_there(study):
    """Draws the results of a study in its folder."""
    if study.draws:
        for program in study.programs:
            run(study, f"experiments/{program}/{program}.py {os.path.relpath(study.folder, ROOT)}")


def keep_pictures(study):
    """Copies the pictures of a study into docs/pictures."""
    for drawn, name in study.pictures.items():
        keep(study.folder / f"{drawn}.png", entries.PICTURES / f"{name}.png")


def begin(study, again):
    """Clears the folder of the study unless an interrupted run by the same sources left it; returns the
    seconds that this took so far. A program goes on with a journal of its own sources alone."""
    file = study.folder / "begun.json"
    same = {"source_hash": source_hash(), "commands": study.commands}
    begun = json.loads(file.read_text()) if file.exists() else {}
    if again or any(begun.get(key) != value for key, value in same.items()):
        shutil.rmtree(study.folder, ignore_errors=True)
        begun = {**same, "seconds": 0}
        write_whole(file, json.dumps(begun))
    return begun["seconds"]


def measure(study, again):
    """Runs the commands of a study; returns what they printed and the seconds that they took, those
    of runs that were interrupted included."""
    before, start = begin(study, again), time.time()
    try:
        printed = study.printed()
    finally:
        seconds = before + time.time() - start
        file = study.folder / "begun.json"
        write_whole(file, json.dumps({**json.loads(file.read_text()), "seconds": seconds}))
    return printed, seconds


def measure_there(study, again):
    """Measures a study and draws it, all in its folder; returns the seconds that it took."""
    printed, seconds = measure(study, again)
    if study.text:
        write_whole(study.folder / study.text, printed)
    draw_there(study)
    return seconds


def built(study):
    """The compiler, version and sources of the programs that measured, as its sidecars say; of a study
    without sidecars as `simulate --version` says, which names no hash of sources."""
    keys = ("compiler", "version", "source_hash")
    for file in sorted(study.folder.glob("*.json")):
        sidecar = json.loads(file.read_text())
        if isinstance(sidecar, dict) and all(key in sidecar for key in keys):
            return {key: sidecar[key] for key in keys}
    asked = [BIN / "simulate", "--version"]
    said = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    version, compiler = re.fullmatch(r"\w+ of qddot (.*), (.*)\n", said).groups()
    return {"compiler": compiler, "version": version}


def make(study, again):
    """Measures a study and keeps its tables, pictures and record."""
    for needed in (read_studies()[name] for name in study.needs):
        if not needed.folder.exists():
            make(needed, again=False)
    inputs = study.inputs
    seconds = measure_there(study, again)
    keep_pictures(study)
    if study.text:
        printed = (study.folder / study.text).read_bytes()
        write_whole(study.data / study.text, printed)
    for pattern in study.tables:
        for table in sorted(study.folder.glob(pattern)):
            keep(table, study.data / table.name, study.columns.get(table.name))
    when = {"date": datetime.date.today().isoformat(), "seconds": round(seconds, 1)}
    record = {**inputs, **when, "processor": processor(), **built(study)}
    write_whole(study.data / "study.json", json.dumps(record, indent=1) + "\n")
    (study.folder / "begun.json").unlink()


def repeat(study):
    """Measures a study beside what docs/data keeps of it, which stays, and prints both. What it needs
    is repeated before it, where that was not done."""
    other = study.repeat()
    needs = [read_studies()[name].repeat() for name in study.needs]
    for one in [needed for needed in needs if not needed.is_complete] + [other]:
        measure_there(one, again=False)
        (one.folder / "begun.json").unlink()
    for line in comparison(study, other):
        print(line)
    for drawn in study.pictures:
        print(f"Picture: {other.folder / drawn}.png")


def show(studies):
    """Prints one line a study: whether it is to be measured, seconds and commands."""
    for study in studies.values():
        record = study.record
        state = "not measured" if not record else "to be measured" if study.due() else "measured"
        seconds = f"{record['seconds']:7.0f} s" if record else " " * 9
        print(f"{study.name:24}{state:16}{seconds}  {'; '.join(study.commands)}")


def check(studies):
    """Prints which are to be measured and, of the others, how many commits changed their code since;
    returns whether none is to be measured."""
    good, commits = True, {}
    for study in studies.values():
        if why := study.due():
            good = False
            print(f"{study.name}: {why}")
        elif not study.quick:
            commits.setdefault(study.commits_since(), []).append(study.name)
    commits.pop(0, None)
    for count in sorted(commits, key=lambda count: -1 if count is None else count):
        said = "an unknown number of" if count is None else count
        print(f"{said} commits changed code since these were measured: {', '.join(commits[count])}")
    return good


def measure_on_second(parser, studies, again):
    """Measures studies for the second column of pages, where this is another processor."""
    if not studies:
        parser.error("--second needs the names of studies")
    for study in studies.values():
        first = study.record and study.record["processor"]
        if not first or first == processor():
            why = f"was measured on this processor, {first}" if first else "has no first column yet"
            parser.error(f"--second {study.name}: the study {why}")
        if study.needs:
            parser.error(f"--second {study.name}: it needs the studies {', '.join(study.needs)}")
    for study in studies.values():
        second = study.on_second()
        print(f"{study.name}: {'; '.join(second.commands)}", flush=True)
        make(second, again)


def main():
    parser = argparse.ArgumentParser(
        prog="./run studies", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="studies of docs/studies.toml (default: all)")
    parser.add_argument("--again", action="store_true", help="measure anew what is measured")
    parser.add_argument("--second", action="store_true", help="measure on a second processor")
    parser.add_argument("--list", action="store_true", help="say what there is")
    parser.add_argument("--draw", action="store_true", help="only draw the pictures anew")
    parser.add_argument("--quick", action="store_true", help="only what takes no time")
    parser.add_argument("--check", action="store_true", help="say what is to be measured")
    arguments = parser.parse_args()
    studies = read_studies()
    for name in arguments.names:
        if name not in studies:
            parser.error(f"there is no study '{name}'; ./run studies --list names them")
    chosen = {name: studies[name] for name in arguments.names or studies}
    if arguments.second:
        measure_on_second(parser, chosen if arguments.names else {}, arguments.again)
        return 0
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
                draw_there(study)
                keep_pictures(study)
        return 0
    for position, study in enumerate(chosen.values(), 1):
        is_due = arguments.again or study.due()
        if is_due or arguments.names:
            print(f"{position}/{len(chosen)} {study.name}: {'; '.join(study.commands)}", flush=True)
            if is_due:
                make(study, arguments.again)
            else:
                repeat(study)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
