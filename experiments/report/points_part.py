"""The points of a study as the page has them: one list a column, and the errors that a chart may
stand over."""

import math
import os

from commands import RunCommands
from study_folder import cell

NUMBERS = (
    "t_reached",
    "error_position",
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


def quantities_part(study):
    """The kinds of error that a chart may show; answers are judged by the first."""
    views = sorted(study.record.views.items(), key=lambda item: item[0] != study.record.judged_by)
    return [quantity_entry(name, view) for name, view in views]
