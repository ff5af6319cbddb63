"""Makes one HTML file of what a study left in a folder, with its motions, that opens by itself.

Call: report.py DIR. Reads DIR/points.csv, DIR/chart.json and whatever else is there of reference.json,
motions.csv with its motions, motions_energy.csv and pictures, and writes DIR/report.html.
"""

import os
import sys
import tempfile

from answers import answers, answers_note
from background_part import left_out_part, provenance_part, reference_part, study_notes
from commands import page_command
from measurements import BadInput, status_of
from methods_part import methods_part
from motion_part import motion_part
from page import html
from pictures_part import pictures_part
from points_part import points_part, quantities_part
from static_part import static_part
from study_folder import read_study

# A page of any scene; browsers read as much in a moment, and mails take it.
MOST_BYTES = 8_000_000
# The part of it for sentences on the motions and all but their blobs.
WORDS_ON_MOTIONS = 20_000


def measured_parts(study):
    """The page's data but for the motion, the chart as a data URI and its notes."""
    pictures, chart, notes = pictures_part(study.directory)
    command = page_command(study.sidecar)
    found = answers(study)
    points = points_part(study)
    content = {
        "title": study.record.scene,
        "until": study.record.until,
        "command": [command] if command else [],
        "notes": study_notes(study) + notes,
        "answers": found,
        "answers_note": answers_note(found),
        "judged_by": study.record.judged_by,
        **methods_part(study),
        **points,
        "quantities": quantities_part(study, points["points"]),
        "left_out": left_out_part(study.sidecar),
        "reference": reference_part(study),
        "provenance": provenance_part(study.sidecar),
        "pictures": pictures,
    }
    return content, chart


def page_of(directory):
    """The page of a folder as text. Raises BadInput where its measurements cannot be read."""
    study = read_study(directory)
    content, chart = measured_parts(study)

    def page(motion, blobs, notes):
        """The page with this motion."""
        whole = content | {"notes": content["notes"] + notes, "motion": motion}
        static = static_part(whole, study.runs, chart)
        return html(study.record.scene, whole, blobs, static)

    room = MOST_BYTES - WORDS_ON_MOTIONS - len(page(None, {}, []).encode("utf-8", "replace"))
    return page(*motion_part(study, room))


def write_whole(path, text):
    """Writes a file that appears whole or not at all. Raises BadInput where it cannot be
    written."""
    folder, name = os.path.split(path)
    try:
        # A folder of its own: two packers may write the same page, and the file has usual rights.
        with tempfile.TemporaryDirectory(prefix=f".{name}.", dir=folder or ".") as own:
            temporary = os.path.join(own, name)
            with open(temporary, "w", encoding="utf-8", errors="replace", newline="\n") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            os.replace(temporary, path)
    except OSError as error:
        raise BadInput(f"{path} cannot be written: {error.strerror}.") from error


def main(arguments):
    """Writes the page of the folder named on the command line; returns the exit status."""
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print("Usage: report.py DIR", file=sys.stderr)
        return 2
    directory = arguments[0]
    path = os.path.join(directory, "report.html")
    try:
        return status_of(lambda: write_whole(path, page_of(directory)))
    except (AttributeError, TypeError) as error:
        print(f"{directory}: a .json file is not as qddot writes it: {error}.", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
