"""What a program's --help says of its options, so that a new option is tried without being told."""

import re
import subprocess
from dataclasses import dataclass

# "  -h,--help   words", "  --until FLOAT=2 ...   words", and the words alone on the next line.
_LINE = re.compile(
    r"^  (?:-\w,)?(?P<name>--[\w-]+|[a-z]\w*)"
    r"(?: (?P<kind>[A-Z]{2,}))?(?:=(?P<default>\[[^\]]*\]|\S+))?"
    r"(?P<several> \.\.\.)?(?:\s+(?P<words>.*))?$"
)


@dataclass(frozen=True)
class Option:
    """One option: `kind` is INT, FLOAT, TEXT or FLAG; `several` values may be joined by commas."""

    name: str
    kind: str
    default: str | None
    several: bool
    words: str

    @property
    def positional(self):
        return not self.name.startswith("--")

    @property
    def choices(self):
        """The words of a list "... of a, b, c" in the option's description."""
        found = re.search(r"\bof ((?:[a-z]\w+, )+[a-z]\w+)", self.words)
        return found.group(1).split(", ") if found else []


def parse_help(text):
    """The options that a help page lists, --help and --version left out."""
    options = []
    for line in text.split("\n"):
        match = _LINE.match(line)
        if not match or (not match["name"].startswith("--") and not match["kind"]):
            continue
        if match["name"] in ("--help", "--version"):
            continue
        options.append(
            Option(
                match["name"],
                match["kind"] or "FLAG",
                match["default"],
                bool(match["several"]),
                match["words"] or "",
            )
        )
    return options


def options_of(program):
    """The options of the executable `program`; raises RuntimeError if its help cannot be read."""
    run = subprocess.run(
        [program, "--help"], capture_output=True, text=True, timeout=60, check=False
    )
    options = parse_help(run.stdout)
    if run.returncode != 0 or not options:
        raise RuntimeError(f"{program} --help ended with status {run.returncode} and no options")
    return options


def methods_of(simulate):
    """Names of methods by what they take: {"step_size": [...], "rtol": [...]}."""
    run = subprocess.run(
        [simulate, "--list-methods", "--csv"],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    methods = {"step_size": [], "rtol": []}
    for line in run.stdout.split("\n")[1:]:
        fields = line.split(",")
        if len(fields) > 3:
            methods[fields[3]].append(fields[0])
    return methods
