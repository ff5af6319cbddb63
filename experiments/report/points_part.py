"""The points of a study as the page has them: one list a column, and the errors that a chart may
stand over."""

import math
import os

from commands import RunCommands
from study_folder import cell

NUMBERS = (
    "t_reached",
    "error_position",
    "error_velocity",
    "error_energy",
    "error_energy_max",
    "error_momentum_max",
    "error_modal_shares",
    "error_position_at_least",
    "error_position_at_most",
    "time_s",
    "time_min_s",
    "setup_s",
    "energy_growth",
)
COUNTS = (
    "steps",
    "rejected",
    "force_evaluations",
    "stiffness_evaluations",
    "factorizations",
    "solves",
    "newton_iterations",
    "indefinite_factorizations",
    "order_reductions",
    "stability_limited_steps",
)
NAMES = {
    "position": "positions at the end",
    "energy": "energy on the way",
    "momentum": "momenta on the way",
    "modes": "energy in the modes",
}

# Errors that methods are not judged by: name, axis, subtitle, and what the reference certifies.
UNJUDGED = {
    "error_velocity": (
        "velocities at the end",
        "relative velocity error",
        "velocity error at t = T: max over nodes, divided by the largest speed",
        "certified_velocity",
    ),
    "error_energy": (
        "energy at the end",
        "relative energy error at the end",
        "energy error at t = T: |E − E of the reference|, divided by the largest kinetic energy",
        "certified_energy",
    ),
}


def cause(run, sentences):
    """Why a run, with the error that it is judged by, is no point of the chart, in a sentence; None
    for a good run."""
    if not run.failure:
        return None
    return sentences.get(run.outcome) or run.failure


def points_part(study):
    """The page's `points` and `counts`."""
    methods = dict.fromkeys(run.method for run in study.runs)
    places = {name: index for index, name in enumerate(methods)}
    commands = RunCommands(study)
    # One sentence for each outcome.
    sentences = study.sidecar.get("outcomes") or {}
    path = os.path.join(study.directory, "points.csv")
    counts = [name for name in COUNTS if all(name in row for _, row in study.rows)]
    points = {
        "method": [places[run.method] for run in study.runs],
        "value": [run.value for run in study.runs],
        "knob": [run.knob for run in study.runs],
        "knob_words": [run.knob_words for run in study.runs],
        "outcome": [run.outcome for run in study.runs],
        "cause": [cause(run, sentences) for run in study.runs],
    }
    for name in (*NUMBERS, *counts):
        points[name] = [cell(path, line, row, name) for line, row in study.rows]
    points["command"] = [commands.of_run(run.method, run.knob, run.value) for run in study.runs]
    return {"points": points, "counts": counts}


def quantity_entry(name, view):
    """One entry of the page's `quantities`."""
    counts = [run.counts for run in view.runs]
    lucky = {
        index: run.counts_at if math.isfinite(run.counts_at) else None
        for index, run in enumerate(view.runs)
        if run.is_lucky
    }
    return {
        "column": view.column,
        "name": NAMES[name],
        "axis": view.quantity.axis,
        "subtitle": view.subtitle,
        "floor": view.floor,
        "floor_words": view.floor_words or None,
        "counts": None if all(counts) else counts,
        "lucky": lucky,
        "failures": [run.failure or None for run in view.runs],
    }


def unjudged_entry(study, points, column):
    """One entry of the page's `quantities`, of an error that the study has no front for; None where
    no good run has it."""
    name, axis, subtitle, certified = UNJUDGED[column]
    failures = [
        run.failure or (None if error is not None else "its error is not known")
        for run, error in zip(study.runs, points[column])
    ]
    if all(failures):
        return None
    floor = study.reference.get(certified)
    return {
        "column": column,
        "name": name,
        "axis": axis,
        "subtitle": f"{subtitle}; no front is drawn, as an error at one time may be small by luck",
        "floor": floor if isinstance(floor, float) and floor > 0 else None,
        "floor_words": None,
        "counts": [False] * len(failures),
        "lucky": {},
        "failures": failures,
    }


def quantities_part(study, points):
    """The kinds of error that a chart may show; answers are judged by the first. `points`: the
    page's."""
    views = sorted(study.record.views.items(), key=lambda item: item[0] != study.record.judged_by)
    entries = [quantity_entry(name, view) for name, view in views]
    others = (unjudged_entry(study, points, column) for column in UNJUDGED)
    return entries + [entry for entry in others if entry]
