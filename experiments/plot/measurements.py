"""Reads the tables that studies write."""

import csv
import json
import math
import sys
from contextlib import contextmanager


class BadInput(Exception):
    """A measurement file that cannot be read; the message is one sentence."""


def status_of(work, *arguments):
    """The exit status of a script with this work: 2, after a sentence, where a file is bad."""
    try:
        work(*arguments)
    except BadInput as error:
        print(error, file=sys.stderr)
        return 2
    return 0


@contextmanager
def reading(path):
    """An open file; what is wrong with it or its content becomes a BadInput."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            yield file
    except (OSError, ValueError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error
        raise BadInput(f"{path} cannot be read: {reason}.") from error


def read_header(path):
    """The names of a CSV file's columns."""
    with reading(path) as file:
        return next(csv.reader(file), [])


def read_rows(path, columns):
    """The rows of a CSV file with a header, each with its line number."""
    with reading(path) as file:
        reader = csv.DictReader(file)
        missing = [name for name in columns if name not in (reader.fieldnames or [])]
        if missing:
            raise BadInput(f"{path} has no column {missing[0]}.")
        return [(reader.line_num, row) for row in reader]


def read_table(path):
    """The rows of a CSV file, as texts by column."""
    return [row for _, row in read_rows(path, ())]


def read_facts(path):
    """The content of a table's sidecar."""
    with reading(path) as file:
        return json.load(file)


def grouped(items, key):
    """The items in lists by their keys, all in the order in which they come."""
    groups = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


def optional(text):
    """The number in a cell; NaN where it is empty."""
    return float(text) if text else math.nan


def parse(path, line, row, column, required):
    """The number in a cell: NaN for an empty cell, and required ones are positive and finite."""
    text = row[column] or ""
    try:
        value = float(text) if text.strip() else math.nan
    except ValueError as error:
        raise BadInput(f"{path}, line {line}: {column} is {text!r}, not a number.") from error
    if required and not 0 < value < math.inf:
        raise BadInput(f"{path}, line {line}: {column} must be a positive number.")
    return value


def interrupted_by(path):
    """What ended the study of the table before it was complete, by the table's sidecar; None where
    that says nothing."""
    try:
        return read_facts(f"{path.removesuffix('.csv')}.json").get("interrupted")
    except (BadInput, AttributeError):
        return None
