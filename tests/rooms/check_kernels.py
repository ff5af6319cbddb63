#!/usr/bin/env python3
"""Holds kernels to what they may define: nothing that another translation unit may define as well.

Of such a symbol (an inline function, an instance of a template) the linker keeps any one copy, and
that of a kernel may need a processor that others run without. Call: check_kernels.py NM OBJECT...
"""

import subprocess
import sys

SHARED = {"W": "weak", "V": "a weak object", "u": "unique"}


def main(arguments):
    nm, *objects = arguments
    wrong = [] if objects else ["there are no objects"]
    for file in objects:
        listed = subprocess.run(
            [nm, "-C", "--defined-only", file], capture_output=True, text=True, check=True
        )
        for line in listed.stdout.splitlines():
            _, kind, name = line.split(" ", 2)
            if kind in SHARED:
                wrong.append(f"{file} defines {name}, which is {SHARED[kind]}")
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
