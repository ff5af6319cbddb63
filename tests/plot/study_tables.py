"""Tables that tests write as a study's, the record that its program makes of them, and pictures."""

import csv
import os
import subprocess
import sys
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
    """Runs a script that draws, as ./run does; its exit status and what it says on stderr."""
    environment = {**os.environ, "PYTHONPATH": str(EXPERIMENTS / "plot")}
    command = [sys.executable, "-B", EXPERIMENTS / script, *words]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


def texts_of(picture):
    """All texts of an SVG picture, in the order of drawing."""
    texts = (text.strip() for text in ElementTree.parse(picture).getroot().itertext())
    return [text for text in texts if text]
