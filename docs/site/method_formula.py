"""The formula of a method: the first comment of the file that defines it, as Markdown."""

import functools
import itertools
import re

import page_data
from page_data import ROOT


@functools.cache
def sources():
    """The text of each C++ file of integrators/ by its path from the root."""
    files = sorted((ROOT / "integrators").rglob("*.cpp"))
    return {str(file.relative_to(ROOT)): file.read_text(encoding="utf-8") for file in files}


def defined_in(text):
    """The names of the methods that a file defines, in its order."""
    return re.findall(r"^Method (\w+)\(\) \{", text, re.MULTILINE)


def file_of(name):
    """The path of the file that defines a method."""
    found = [path for path, text in sources().items() if name in defined_in(text)]
    if len(found) != 1:
        where = f"{len(found)} files of integrators/ define it" if found else "no file defines it"
        raise page_data.BadPage(f"method {name} is in the registry, but {where}")
    return found[0]


def escaped(text):
    """A text whose characters mean nothing to Markdown; code between backticks stays as it is."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(
        part if part.startswith("`") else re.sub(r"([\\_*<])", r"\\\1", part) for part in parts
    )


def as_markdown(lines):
    """A comment as Markdown: indented lines are blocks of code, the others paragraphs."""
    blocks = []  # [whether it is code, its lines]
    for line in lines:
        is_code = line.startswith("  ")
        if not blocks or not line.strip() or blocks[-1][0] != is_code:
            blocks.append([is_code, []])
        if line.strip():
            blocks[-1][1].append(line[3:] if is_code else line.strip())
    return "\n\n".join(
        "```text\n" + "\n".join(block) + "\n```" if is_code else escaped(" ".join(block))
        for is_code, block in blocks
        if block
    )


def formula_of(name):
    """The formula of a method and what its file says of it, as Markdown."""
    path = file_of(name)
    lines = sources()[path].splitlines()
    comment = itertools.takewhile(lambda line: line.startswith("//"), lines)
    markdown = as_markdown(line[2:] for line in comment)
    if "```text" not in markdown:
        raise page_data.BadPage(
            f"method {name} has no formula: the first comment of {path} has no indented line"
        )
    return markdown


def defined_with(name):
    """The other methods that are defined in the same file."""
    return [other for other in defined_in(sources()[file_of(name)]) if other != name]
