"""Shows one motion by several methods at one step size: as a picture and as a page that plays.

Call: motion.py DIR --scene SCENE --methods A,B --step-size H [--until T]. Runs build/bin/simulate,
and writes DIR/motion.png, DIR/motion.svg and DIR/motion.html.
"""

import argparse
import sys
import tempfile

from motion_page import page_of
from picture import draw_motion
from report import write_whole
from runs import Refused, call_simulate, drawn_scene, exact_run, runs_of, sampling
from measurements import status_of
from style import use_style

USUAL = "explicit_euler,symplectic_euler,implicit_euler,verlet"


def options(arguments):
    """The command line's options."""
    parser = argparse.ArgumentParser(
        prog="./run motion",
        usage="%(prog)s [SCENE] --step-size H [--methods A,B] [--until T]",
        description="Shows one motion by several methods at one step size: motion.png and motion.html.",
        allow_abbrev=False,
    )
    parser.add_argument("folder", nargs="?", help=argparse.SUPPRESS)
    parser.add_argument("--scene", default="cloth", help=argparse.SUPPRESS)
    parser.add_argument("--step-size", required=True, metavar="H", help="the step size in s")
    parser.add_argument(
        "--methods", default=USUAL, metavar="A,B", help=f"methods of fixed steps (default: {USUAL})"
    )
    parser.add_argument("--until", metavar="T", help="the end in s (default: the scene's own)")
    return parser.parse_args(arguments)


def show(given):
    """Makes the runs, the picture and the page. Raises Refused where simulate refuses an option."""
    methods = list(dict.fromkeys(given.methods.split(",")))
    until = ["--until", given.until] if given.until else []
    with tempfile.TemporaryDirectory() as folder:
        # Refuses what is wrong with the scene and the numbers, in simulate's words.
        first = ("--method", methods[0], "--step-size", given.step_size, *until)
        call_simulate("--scene", given.scene, *first)
        drawn = drawn_scene(folder, given.scene, given.until)
        every = sampling(drawn, float(given.step_size))
        runs = runs_of(folder, drawn, methods, given.step_size, every)
        exact = exact_run(folder, drawn, every)
        use_style()
        draw_motion(drawn, given.step_size, exact, runs).save_as(given.folder, "motion")
        page = page_of(given.folder, drawn, given.step_size, exact, runs)
        write_whole(f"{given.folder}/motion.html", page)
    for run in runs:
        if run.failed:
            print(f"motion: {run.method}: {run.why}", file=sys.stderr)


def main(arguments):
    """Does what the command line asks for; returns the exit status."""
    try:
        return status_of(show, options(arguments))
    except Refused as refusal:
        words = str(refusal).replace("simulate: ", "motion: ", 1)
        print(words.replace("--method:", "--methods:", 1), file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
