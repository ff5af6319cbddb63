"""What lies behind a page's numbers, as labels with words: what was left out of the scene, the
reference, and what made it all."""

import math
import shlex

from style import number, seconds
from study_folder import look

STIFFNESS = {True: "constant", False: "changes with the motion"}


def in_words(value, unit=""):
    """A number with its unit; None where it is not known."""
    return None if value is None else f"{number(value)} {unit}".strip()


def labelled(*pairs):
    """The pairs of label and words as lists, without unknown ones."""
    return [[label, str(words)] for label, words in pairs if words not in (None, "")]


def left_out_part(sidecar):
    """The page's `left_out`; None where the study says nothing of it."""
    reduced = sidecar.get("reduced")
    if not isinstance(reduced, dict):
        return None
    return {
        "unknowns_drawn": reduced.get("unknowns_drawn"),
        "unknowns": reduced.get("unknowns"),
        "findings": reduced.get("reductions") or [],
        "facts": labelled(
            ("largest frequency at the start", in_words(reduced.get("omega_max"), "1/s")),
            (
                "Verlet's largest stable step there",
                in_words(reduced.get("largest_stable_step"), "s"),
            ),
            ("parts that no spring joins", reduced.get("parts")),
            ("stiffness matrix", STIFFNESS.get(reduced.get("stiffness_is_constant"))),
            ("unstable directions at the start", reduced.get("unstable_directions")),
        ),
    }


def reference_part(study):
    """The page's `reference`: how it was made, to what it is certified, and until when the motion
    can be known."""
    file = study.reference
    if not file:
        return []
    chaos = file if study.record.is_beyond_horizon else {}
    rate = chaos.get("lyapunov")
    symmetric = look(file, "out_of_symmetry", "horizon") if file.get("only_symmetric") else None
    return labelled(
        ("made by", file.get("made_by")),
        ("positions certified to", in_words(file.get("certified_position"))),
        ("velocities certified to", in_words(file.get("certified_velocity"))),
        ("energy certified to", in_words(file.get("certified_energy"))),
        ("one rounding of the start moves the end by", in_words(file.get("rounding_effect"))),
        ("horizon", in_words(chaos.get("horizon"), "s")),
        ("errors grow ten times in", seconds(math.log(10) / rate) if rate else None),
        ("symmetry lasts until", in_words(symmetric, "s")),
        ("largest displacement", in_words(look(file, "scales", "displacement"), "m")),
        ("largest speed", in_words(look(file, "scales", "speed"), "m/s")),
        ("largest kinetic energy", in_words(look(file, "scales", "kinetic"), "J")),
        ("made in", None if file.get("seconds") is None else seconds(file["seconds"])),
    )


def provenance_part(sidecar):
    """The page's `provenance`."""
    libraries = sidecar.get("libraries") or {}
    return labelled(
        ("processor", sidecar.get("cpu")),
        ("vector kernels", sidecar.get("kernels")),
        ("compiler", sidecar.get("compiler")),
        ("compiler flags", sidecar.get("flags")),
        ("libraries", ", ".join(map(" ".join, libraries.items()))),
        ("BLAS", sidecar.get("blas")),
        ("qddot", sidecar.get("version")),
        ("sources", sidecar.get("source_hash")),
        ("measured", sidecar.get("date")),
        ("measured by", shlex.join(sidecar.get("command_line") or [])),
        ("scene's nodes", look(sidecar, "scene", "nodes")),
        ("scene's springs", look(sidecar, "scene", "springs")),
        ("scene's dimension", look(sidecar, "scene", "dimension")),
        ("scene's hash", look(sidecar, "scene", "hash")),
    )


def sentence(words):
    """Words that may be two lines, as one that begins with a capital."""
    line = words.replace("\n", " ")
    return line[:1].upper() + line[1:]


def study_notes(study):
    """What a reader must know of the study and its motion first, in sentences."""
    record = study.record
    notes = [sentence(words) for words in record.caveats]
    limit = record.views["position"].chaotic_below
    if limit and not record.is_beyond_horizon:
        notes.append(
            f"The motion is chaotic: position errors below {number(limit)} depend on how a method"
            " rounds."
        )
    if not study.reference:
        notes.append("There is no reference.json: what the errors are certified to is not known.")
    if not study.sidecar:
        notes.append("There is no points.json: how the runs were made is not known.")
    if all(run.failure for run in study.runs):
        notes.append("No run gave a point.")
    return notes
