"""What the pages' templates can call: the measured tables of docs/data, numbers in words, and files
of the project.

A page says {{ fastest("cloth", 1e-3).time }} and not 0.98 ms: what is measured anew is said anew.
"""

import csv
import functools
import json
import math
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "docs/data"
SECOND = "second"  # the folder, in that of a study, of what another processor measured
NOTHING = "–"  # where a table has no number


class BadPage(Exception):
    """A template asks for what there is not; the message is one sentence."""


def seconds(value):
    """A time in two digits and a fitting unit: 0.98 ms, 12 µs, 3.4 s, 2 min 10 s; – for an empty cell."""
    if value == "":
        return NOTHING
    value = float(value)
    if not math.isfinite(value):
        return NOTHING
    if value >= 99.5:
        whole = round(value)
        return f"{whole // 60} min {whole % 60} s" if whole % 60 else f"{whole // 60} min"
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6), ("ns", 1e-9)):
        if value >= 0.0995 * size or unit == "ns":
            return f"{figures(value / size)} {unit}"
    raise AssertionError(value)


def figures(value, digits=2):
    """A number in that many digits, no exponent between 1e-3 and 1e7, thousands apart: 0.98, 12,300; – for
    an empty cell."""
    value = float(value) if value != "" else math.nan
    if not math.isfinite(value):
        return "∞" if value > 0 else NOTHING
    if value == 0:
        return "0"
    if not 1e-3 <= abs(value) < 1e7:
        return small(value, digits)
    rounded = float(f"{value:.{digits}g}")
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    return f"{rounded:,.{decimals}f}".replace("-", "−")


def small(value, digits=2):
    """A number with its power of ten: 9.1e-7, 1e-4."""
    mantissa, exponent = f"{float(value):.{digits - 1}e}".split("e")
    mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
    mantissa = mantissa.replace("-", "−")
    return f"{mantissa}e{int(exponent)}"


def accuracy(value):
    """An accuracy as the pages write it: 1e-3."""
    return f"{float(value):.0e}".replace("e-0", "e-").replace("e+0", "e")


def percent(value, digits=2):
    """A part of one as a percentage: 12 %."""
    return f"{figures(100 * float(value), digits)} %"


def times(ratio):
    """A ratio in two digits: 3.4."""
    return figures(ratio)


@functools.cache
def record(study):
    """How a study was made: commands, date, processor, compiler, seconds."""
    try:
        return json.loads((DATA / study / "study.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise BadPage(f"study {study} is not measured: ./run studies {study}") from None


def command(study):
    """What a user types to measure the study again, a line a command."""
    lines = []
    for line in record(study)["commands"]:
        python = line.split()[0].endswith(".py")
        lines.append(("/usr/bin/python3 " if python else "build/bin/") + line)
    return "\n".join(lines)


def processor(study):
    """The processor on which a study was measured."""
    return record(study)["processor"]


def measured(study):
    """The names for rows(), record() and the others of a study and, where it was measured on a second
    processor, of that."""
    has_second = (DATA / study / SECOND / "study.json").exists()
    return [study] + [f"{study}/{SECOND}"] * has_second


def column(words, study):
    """The head of a column of a study or of its second processor: with its name where there are two."""
    name = study.removesuffix(f"/{SECOND}")
    return words if len(measured(name)) == 1 else f"{processor(study)}: {words}"


UNSAID = "\0"  # stands where made() has nothing to say, until render.py takes it out
said_on_page = set()  # studies, processors and dates that the page at hand has named; render.py clears it


def made(*studies):
    """The words under a table: the command that measures it again, the processor and the date. Each
    study, processor and date is named once on a page; nothing is left where all were."""
    new = [study for study in studies if study not in said_on_page]
    if not new:
        return UNSAID
    processors = sorted({record(study)["processor"] for study in new})
    dates = sorted({record(study)["date"] for study in new})
    words = [f"`./run studies {' '.join(new)}`"]
    if not said_on_page.issuperset(processors):
        words.append(f"one core of an {' and an '.join(processors)}")
    if not said_on_page.issuperset(dates):
        words.append(" to ".join(dict.fromkeys((dates[0], dates[-1]))))
    said_on_page.update(new, processors, dates)
    command_words, *where = words
    return f"({command_words}{'; ' if where else ''}{', '.join(where)})"


@functools.cache
def rows_of(study, table):
    record(study)
    try:
        with open(DATA / study / table, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except FileNotFoundError:
        raise BadPage(f"study {study} has no table {table}") from None


def matches(cell, wanted):
    if isinstance(wanted, (int, float)) and not isinstance(wanted, bool):
        try:
            return math.isclose(float(cell), wanted, rel_tol=1e-6)
        except ValueError:
            return False
    return cell in wanted if isinstance(wanted, (list, tuple)) else cell == wanted


def rows(study, table, **where):
    """The rows of a table (dicts of texts) whose columns have these values; a list means any of
    these, numbers agree to 1e-6."""
    found = rows_of(study, table)
    for column in where:
        if found and column not in found[0]:
            raise BadPage(f"{study}/{table} has no column {column}")
    return [row for row in found if all(matches(row[c], value) for c, value in where.items())]


def row(study, table, **where):
    """The one row with these values."""
    found = rows(study, table, **where)
    if len(found) != 1:
        raise BadPage(f"{study}/{table} has {len(found)} rows with {where}, not one")
    return found[0]


def text(study, file):
    """What a program printed."""
    record(study)
    return (DATA / study / file).read_text(encoding="utf-8").rstrip("\n")


def facts(study, file):
    """The content of a JSON file of a study."""
    return json.loads(text(study, file))


def sample(path, begin=None, end=None):
    """A file of the project, or its lines from the one that holds `begin` to the one before that
    which holds `end`."""
    lines = (ROOT / path).read_text(encoding="utf-8").splitlines()
    first = next((i for i, line in enumerate(lines) if begin in line), None) if begin else 0
    if first is None:
        raise BadPage(f"{path} has no line with '{begin}'")
    last = len(lines)
    if end:
        last = next((i for i in range(first + 1, len(lines)) if end in lines[i]), None)
        if last is None:
            raise BadPage(f"{path} has no line with '{end}' after '{begin}'")
    return "\n".join(lines[first:last]).strip("\n")


def version():
    """The project's version, as CMake has it."""
    return re.search(r"VERSION ([\d.]+)", sample("CMakeLists.txt", "project(qddot"))[1]
