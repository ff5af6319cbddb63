#!/usr/bin/env python3
"""Finds types and inline functions that are defined twice under one name, which no compiler sees.

The linker keeps one copy of each function that both have, and unoptimised code then calls it for the
other, too. Call: check_definitions.py ROOT. Reads formatted code: what is of a namespace starts its line.
"""

import re
import sys
from pathlib import Path

OPENS = re.compile(r"^(?:inline )?namespace(?: (\w[\w: ]*))? \{$")
CLOSES = re.compile(r"^\}  // namespace")
SUITE = re.compile(r"^BOOST_(?:AUTO|FIXTURE)_TEST_SUITE\((\w+)")
SUITE_ENDS = re.compile(r"^BOOST_AUTO_TEST_SUITE_END")
TYPE = re.compile(
    r"^(?:template <.*> )?(?:struct|class|enum class|union) (?:\[\[\w+\]\] )?([\w:]+)\b(?!.*;$)(?!<)"
)
INLINE = re.compile(r"^(?:constexpr|inline) .*\)(?: const)?(?= \{)")


def definitions(text):
    """The qualified names of the types that a file defines for others to see, and the signatures of
    its inline functions."""
    spaces = []
    for line in text.splitlines():
        if opened := OPENS.match(line):
            spaces.append(opened[1] and opened[1].replace("inline ", ""))  # None: nobody sees it
        elif suite := SUITE.match(line):
            spaces.append(suite[1])
        elif CLOSES.match(line) or SUITE_ENDS.match(line):
            spaces.pop()
        elif None not in spaces:
            if found := TYPE.match(line):
                yield "::".join([*spaces, found[1]])
            elif found := INLINE.match(line):
                yield "::".join([*spaces, found[0]])


def main(arguments):
    root, places = Path(arguments[0]), {}
    for top in ("src", "integrators", "experiments", "tests"):
        for file in sorted((root / top).rglob("*.[ch]pp")):
            for name in definitions(file.read_text()):
                places.setdefault(name, []).append(str(file.relative_to(root)))
    twice = {name: files for name, files in places.items() if len(files) > 1}
    for name, files in twice.items():
        print(f"{name} is defined in {' and in '.join(files)}", file=sys.stderr)
    print(f"{len(places)} types and inline functions")
    return 1 if twice or not places else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
