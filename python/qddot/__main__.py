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
    # Programs that print a command to copy put this before it.
    caller = {"QDDOT_CALLER": f"{Path(sys.executable).name} -m qddot"}
    os.execve(programs, [str(programs), *sys.argv[1:]], os.environ | caller)


if __name__ == "__main__":
    main()
