#!/usr/bin/env python3
"""Checks the symbols and the operations of kernels.

Kernels must not define symbols that another translation unit may define too (an inline function, an
instance of a template). The linker keeps any one copy, and that of a kernel may need a newer
processor. Kernels of the levels v3 and v4 must multiply and add in one operation. Call:
check_kernels.py NM OBJDUMP OBJECT...
"""

import subprocess
import sys

SHARED = {"W": "weak", "V": "a weak object", "u": "unique"}
FUSED = ("v3", "v4")


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def main(arguments):
    nm, objdump, *objects = arguments
    wrong = [] if objects else ["there are no objects"]
    for file in objects:
        for line in output(nm, "-C", "--defined-only", file).splitlines():
            _, kind, name = line.split(" ", 2)
            if kind in SHARED:
                wrong.append(f"{file} defines {name}, which is {SHARED[kind]}")
        if any(f"_{level}.dir" in file for level in FUSED) and "vfmadd" not in output(
            objdump, "-d", file
        ):
            wrong.append(f"{file} multiplies and adds in two operations")
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
