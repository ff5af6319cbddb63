"""What a measurement depends on: a hash of the code that a study runs, folder by folder.

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


def path_of(include):
    """The path from the root of a header as it is included."""
    return "src/" + include if include.startswith("qddot/") else include


def sources_of(header):
    """A header with its source, if it has one."""
    return [file for file in (header, header.with_suffix(".cpp")) if file.exists()]


def measuring(files):
    """The files of src/qddot/measure that these use, by what they include. A source without a header
    of its own belongs to its folder."""
    seen, waiting = set(), list(files)
    while waiting:
        file = waiting.pop()
        if file in seen:
            continue
        seen.add(file)
        for include in re.findall(r'^#include "([^"]+)"', file.read_text(encoding="utf-8"), re.M):
            path = path_of(include)
            if path.startswith(("src/qddot/measure/", "experiments/kit/")):
                waiting += sources_of(ROOT / path)
    found = {file for file in seen if file.is_relative_to(ROOT / "src/qddot/measure")}
    alone = (file for folder in {f.parent for f in found} for file in folder.glob("*.cpp"))
    return found | {file for file in alone if not file.with_suffix(".hpp").exists()}


def own_files(program):
    """The C++ files of a program; of a script those of the module for Python."""
    folders = [ROOT / "experiments" / program]
    if program.startswith("fuzz_"):
        folders = [ROOT / "tests/independent"]
    files = {file for folder in folders for file in folder.rglob("*.[ch]pp")}
    if not files:
        files = {
            ROOT / "src/qddot/qddot.hpp",
            *(ROOT / "python/extension").glob("*.[ch]pp"),
        }
    return files


def files_of(program):
    """The files that decide what a program measures: the model, the integrators, what it uses of
    src/qddot/measure, and its own."""
    shared = {file for room in ("src", "integrators") for file in (ROOT / room).rglob("*.[ch]pp")}
    own = own_files(program)
    return shared | own | measuring(own)


def state_of(programs):
    """The hash of the files in each folder that one of the programs depends on, by folder."""
    files = sorted({file for program in programs for file in files_of(program)})
    digests = {}
    for file in files:
        folder = file.parent.relative_to(ROOT).as_posix()
        digest = digests.setdefault(folder, hashlib.sha256(folder.encode()))
        digest.update(file.name.encode())
        digest.update(without_words(file.read_text(encoding="utf-8")).encode())
    return {folder: digest.hexdigest()[:16] for folder, digest in sorted(digests.items())}


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
