"""The points of a study as the page has them: one list a column, and the errors that a chart may
stand over."""

import math
import os

from commands import RunCommands
from measurements import parse

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
    "order_mean",
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


def finite(value):
    """The number, or None where it is NaN or infinite."""
    return value if math.isfinite(value) else None


def read_column(study, name):
    """A column's numbers, None where there is none, as in a column that is missing. Raises BadInput
    for a cell that is no number."""
    if name not in study.columns:
        return [None] * len(study.rows)
    path = os.path.join(study.directory, "points.csv")
    return [finite(parse(path, line, row, name, False)) for line, row in study.rows]


def whole(values):
    """Counts, which are whole numbers, without a fraction."""
    return [int(value) if value is not None and value.is_integer() else value for value in values]


def outcome_sentences(sidecar):
    """What points.json says of each outcome, {name: sentence}."""
    outcomes = sidecar.get("outcomes")
    pairs = outcomes.items() if isinstance(outcomes, dict) else ()
    return {name: words for name, words in pairs if isinstance(words, str)}


def points_part(study):
    """The page's `points` and `counts`."""
    methods = {run.method: place for place, run in reversed(list(enumerate(study.runs)))}
    places = {name: index for index, name in enumerate(sorted(methods, key=methods.get))}
    commands = RunCommands(study)
    sentences = outcome_sentences(study.sidecar)
    counts = [name for name in COUNTS if name in study.columns]
    points = {
        "method": [places[run.method] for run in study.runs],
        "value": [run.value for run in study.runs],
        "knob": [run.knob for run in study.runs],
        "knob_words": [run.knob_words for run in study.runs],
        "outcome": [run.outcome for run in study.runs],
        # In a sentence, why a run is no point by the error that judges it.
        "cause": [
            (sentences.get(run.outcome) or run.failure) if run.failure else None
            for run in study.runs
        ],
    }
    points |= {name: read_column(study, name) for name in NUMBERS}
    points |= {name: whole(read_column(study, name)) for name in ("timed_runs", *counts)}
    points["command"] = [commands.of_run(run.method, run.knob, run.value) for run in study.runs]
    return {"points": points, "counts": counts}


def quantity_entry(name, view):
    """One entry of the page's `quantities`."""
    counts = [run.counts for run in view.runs]
    return {
        "column": view.column,
        "name": NAMES[name],
        "axis": view.quantity.axis,
        "subtitle": view.subtitle,
        "floor": view.floor,
        "floor_words": view.floor_words or None,
        "counts": None if all(counts) else counts,
        "failures": [run.failure or None for run in view.runs],
    }


def quantities_part(study):
    """The kinds of error that a chart may show; answers are judged by the first."""
    views = sorted(study.record.views.items(), key=lambda item: item[0] != study.record.judged_by)
    return [quantity_entry(name, view) for name, view in views]
