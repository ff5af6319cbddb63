"""What a measurement depends on: a hash of the code of each folder that a study runs.

Comments, white space and sentences (strings with a space in them) are left out, since none of them
changes a number.
"""

import hashlib
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STRING = r'"(?:\\.|[^"\\\n])*"'
TOKENS = re.compile(
    rf"(?P<comment>//[^\n]*|/\*.*?\*/)|(?P<strings>{STRING}(?:\s*{STRING})*)|(?P<rest>.)", re.S
)


def without_words(source):
    """The text of a C++ file without comments, sentences, and white space that separates no words. A
    sentence may stand in several strings."""

    def kept(token):
        if token["comment"]:
            return " "
        if token["strings"]:
            said = re.sub(r'"\s*"', "", token["strings"])
            return '""' if " " in said else said
        return token[0]

    text = re.sub(r"\s*([^\w\s])\s*", r"\1", TOKENS.sub(kept, source))
    return re.sub(r"\s+", " ", text)


def folder_hash(folder):
    """The hash of all C++ files of a folder, its name included; not of folders below it."""
    digest = hashlib.sha256(folder.encode())
    for file in sorted((ROOT / folder).glob("*.[ch]pp")):
        digest.update(file.name.encode())
        digest.update(without_words(file.read_text(encoding="utf-8")).encode())
    return digest.hexdigest()[:16]


def folders_of(program):
    """The folders whose code decides what a program measures: the model, the integrators, what
    measures, and the program's own."""
    wanted = ["src", "integrators", "experiments/measure", f"experiments/{program}"]
    if program.startswith("fuzz_"):
        wanted.append("tests/independent")
    return sorted(
        {
            file.parent.relative_to(ROOT).as_posix()
            for name in wanted
            for file in (ROOT / name).rglob("*.[ch]pp")
        }
    )


def state_of(programs):
    """The hash of each folder that one of the programs depends on."""
    folders = {folder for program in programs for folder in folders_of(program)}
    return {folder: folder_hash(folder) for folder in sorted(folders)}


def changed(recorded, programs):
    """The folders of these programs that are not as a study recorded them: changed, new, or gone."""
    now = state_of(programs)
    names = sorted(set(now) | set(recorded))
    return [name for name in names if now.get(name) != recorded.get(name)]


def source_hash():
    """The hash of all that programs are made of, words included, as their journals tell it apart."""
    digest = hashlib.sha256()
    for room in ("src", "integrators", "experiments"):
        for file in sorted((ROOT / room).rglob("*.[ch]pp")):
            digest.update(file.read_bytes())
    return digest.hexdigest()[:16]
