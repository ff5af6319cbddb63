"""Tables that tests write as a study's, the record that its program makes of them, and pictures."""

import csv
import multiprocessing
import os
import runpy
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

from programs import run

EXPERIMENTS = Path(__file__).resolve().parents[2] / "experiments"


def write_table(path, rows, columns=None):
    """Writes dicts as a CSV file with these columns alone, or all of the first row; numbers to
    their last bit."""
    columns = columns or list(rows[0])
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)


def read_table(path):
    """The rows of a CSV file."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def judge(folder):
    """Makes the record of the tables in a folder."""
    run(["work_precision", "--judge", folder, "--force"]).check_returncode()


def draw(script, *words):
    """Runs a script that draws in a copy of this process, which has matplotlib; its exit status and
    what it says on stderr."""
    import matplotlib.pyplot

    def work():
        os.dup2(said.fileno(), 2)
        sys.argv, sys.stdout = [script, *map(str, words)], None
        sys.path.insert(0, str((EXPERIMENTS / script).parent))
        runpy.run_path(str(EXPERIMENTS / script), run_name="__main__")

    with tempfile.TemporaryFile("w+") as said:
        copy = multiprocessing.get_context("fork").Process(target=work)
        copy.start()
        copy.join()
        said.seek(0)
        return copy.exitcode, said.read()


def draw_again(script, *words):
    """Runs a script that draws by itself, as ./run does: sets have another order there."""
    environment = {**os.environ, "PYTHONPATH": str(EXPERIMENTS / "plot")}
    subprocess.run([sys.executable, "-B", EXPERIMENTS / script, *words], env=environment, check=True)


def texts_of(picture):
    """All texts of an SVG picture, in the order of drawing."""
    texts = (text.strip() for text in ElementTree.parse(picture).getroot().itertext())
    return [text for text in texts if text]
