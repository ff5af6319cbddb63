#!/usr/bin/env python3
"""Holds each source's level of optimisation against that of the header it takes precompiled.

GCC compiles a source at the level of its precompiled header, whatever the source's own options say:
what is to be timed would silently be timed without optimisation.
"""

import json
import re
import subprocess
import sys


def level(command):
    """The last -O of a command, which is the one that counts."""
    levels = re.findall(r"(?<=\s)-O\S*", command)
    return levels[-1] if levels else "-O0"


def main():
    folder = sys.argv[1]
    listed = subprocess.run(
        ["ninja", "-C", folder, "-t", "compdb"], check=True, capture_output=True, text=True
    )
    headers, sources = {}, []
    for entry in json.loads(listed.stdout[listed.stdout.index("[") :]):
        command = entry["command"]
        header = re.search(r"-include (\S*/cmake_pch\.hxx)", command)
        if not header:
            continue
        if "-x c++-header" in command:
            headers[header[1]] = level(command)
        elif " -c " in command:
            sources.append((entry["output"], header[1], level(command)))
    wrong = [
        f"{name}: {own}, its header {headers[h]}" for name, h, own in sources if own != headers[h]
    ]
    print(f"{len(sources)} sources with {len(headers)} precompiled headers")
    if not sources or wrong:
        sys.exit("\n".join(wrong) or "no source has a precompiled header")


if __name__ == "__main__":
    main()
