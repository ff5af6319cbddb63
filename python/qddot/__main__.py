"""Runs a program: python -m qddot advise --scene pendulum --accuracy 1e-4."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def main() -> None:
    """Becomes the program that the first argument names, with all others."""
    programs = Path(__file__).with_name("programs")
    if not programs.exists():
        sys.exit(
            "qddot: this module was installed without the programs; a wheel of './run wheel' has "
            "them, and './run build' makes them in a clone"
        )
    os.execv(programs, [str(programs), *sys.argv[1:]])


if __name__ == "__main__":
    main()
