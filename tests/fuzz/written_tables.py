"""Whether tables and sidecars that programs wrote are whole, and whether two tables say the same."""

import csv
import io
import json
import os
import re
from pathlib import Path

NOT_FINITE = {"nan", "-nan", "+nan", "inf", "-inf", "+inf", "infinity", "-infinity"}
# Measured times (and memory) and what is computed from them: columns, and tables of who was the
# fastest.
TIMES = re.compile(
    r"^seconds$|_s$|per_second$|^(structured|stock)_(force|stiffness|factorization|solve|rest)$"
    r"|^(ratio|is_at_least|margin|runner_up|timed_runs|gflops)$"
    r"|^bytes$"
)
TABLES_OF_TIMES = {"front.csv", "crossover.csv", "kinds.csv", "ratios.csv", "exponents.csv"}


def is_time(column):
    """Whether a column's name is one of measured times."""
    return bool(TIMES.search(column))


def rows_of(path):
    """The rows of an RFC 4180 table; raises ValueError with what is wrong."""
    text = Path(path).read_bytes().decode()
    if not text.endswith("\n"):
        raise ValueError("its last line does not end")
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as error:
        raise ValueError(str(error)) from None
    if not rows or not all(rows[0]):
        raise ValueError("it has no header or a column without a name")
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(rows[0]):
            raise ValueError(f"row {number} has {len(row)} fields, the header {len(rows[0])}")
        bad = NOT_FINITE.intersection(field.lower() for field in row)
        if bad:
            raise ValueError(f"row {number} has a field {bad.pop()}")
    return rows


def _refuse(word):
    raise ValueError(f"it has the number {word}")


def json_of(path):
    """The content of a JSON file; raises ValueError with what is wrong."""
    return json.loads(Path(path).read_bytes().decode(), parse_constant=_refuse)


def faults(folder, names):
    """Sentences on files among `names` in `folder` that are not whole: tables, sidecars,
    leftovers."""
    for name in sorted(names):
        path = os.path.join(folder, name)
        if name.endswith(".part"):
            yield f"{name} is left"
        elif os.path.islink(path) or not os.path.isfile(path):
            continue
        elif name.endswith((".csv", ".json")):
            try:
                (rows_of if name.endswith(".csv") else json_of)(path)
            except ValueError as error:
                yield f"{os.path.basename(name)}: {error}"
            if name.endswith(".csv") and not os.path.exists(path[:-4] + ".json"):
                yield f"{os.path.basename(name)} has no sidecar"


def differences(one, other):
    """Sentences on where two folders' tables differ, measured times left out."""
    tables = [{n for n in os.listdir(folder) if n.endswith(".csv")} for folder in (one, other)]
    for name in sorted(tables[0] ^ tables[1]):
        yield f"{name} is in {one if name in tables[0] else other} alone"
    for name in sorted(tables[0] & tables[1]):
        a, b = (rows_of(os.path.join(folder, name)) for folder in (one, other))
        if a[0] != b[0]:
            yield f"{name}: columns {a[0]} and {b[0]}"
        if a[0] != b[0] or name in TABLES_OF_TIMES:
            continue
        if len(a) != len(b):
            yield f"{name}: {len(a) - 1} and {len(b) - 1} rows"
            continue
        columns = [k for k, column in enumerate(a[0]) if not is_time(column)]
        for number, (x, y) in enumerate(zip(a, b), 1):
            unlike = [k for k in columns if x[k] != y[k]]
            if unlike:
                k = unlike[0]
                yield f"{name}, row {number}, {a[0][k]}: {x[k]} and {y[k]}"
                break
