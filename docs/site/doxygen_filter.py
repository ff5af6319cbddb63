"""Prints a header for Doxygen, with its plain comments as those that Doxygen reads.

    doxygen_filter.py FILE

A block of // lines directly above a declaration becomes its description, a comment behind a member
that member's. Lines that a block indents, as formulas, are shown as they are, and words between
backquotes as code.
"""

import re
import sys
from pathlib import Path

WHOLE = re.compile(r"^(\s*)//(.*)$")  # a line that is a comment
BEHIND = re.compile(r"^(\s*[^/\s].*?[;,\w]\s*)//(.*)$")  # one behind a member


def escaped(text):
    """Words as they are, whatever Doxygen would take for a command."""
    text = re.sub(r"([\\@#%<>&\"])", r"\\\1", text)
    return re.sub(r"`([^`]+)`", r"<tt>\1</tt>", text)


def description(texts):
    """The lines of a block for Doxygen."""
    made, is_formula = ["/**"], False
    for text in texts:
        if text.startswith("  ") != is_formula:
            is_formula = not is_formula
            made.append(r"\verbatim" if is_formula else r"\endverbatim")
        made.append(text if is_formula else escaped(text))
    return [*made, r"\endverbatim */" if is_formula else "*/"]


def filtered(lines):
    """The lines with their comments turned."""
    made, block = [], []
    column = None  # where the comment behind a member begins, whose further lines stand below that
    for line in lines:
        behind, whole = BEHIND.match(line), WHOLE.match(line)
        if whole and len(whole[1]) == column:
            made.append(f"{whole[1]}///<{escaped(whole[2])}")
            continue
        column = len(behind[1]) if behind else None
        if whole:
            block.append(whole[2])
            continue
        if block and line.strip():
            made += description(block)
        block = []
        made.append(f"{behind[1]}///<{escaped(behind[2])}" if behind else line)
    return made


def main():
    source = Path(sys.argv[1]).read_text(encoding="utf-8")
    # Doxygen loses the names before an inline namespace.
    source = source.replace("namespace qddot::inline ", "namespace qddot::")
    print("\n".join(filtered(source.splitlines())))


if __name__ == "__main__":
    main()
