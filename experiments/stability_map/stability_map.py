"""Draws where methods are stable, by theory and measured, as the program stability_map found it.

Call: stability_map.py DIR, the folder with limits.csv, linear.csv, modal.csv, adaptive.csv and
map.csv. Writes DIR/stability_map.png and .svg with the outcomes of whole runs. Writes
DIR/stability_modes.png and .svg with the damping of an oscillator and of the scene's natural modes.
"""

import math

from damping_panels import DampingSheet
from outcome_panels import OutcomeSheet
from outcomes import Run
from measurements import parse, read_facts, read_rows
from sheet import main

RUN_NUMBERS = ("value", "h", "h_omega", "amplitude", "growth_rate", "omega_max", "buckling_rate")
LIMITS = ("h_omega_limit_predicted", "h_omega_limit_measured")
MODE_NUMBERS = ("h", "omega", "h_omega", "damping_ratio_predicted", "damping_ratio_measured")
STEP_NUMBERS = (
    "rtol",
    "omega_fast",
    "h_omega_mean",
    "rejected_share",
    "steps",
    "stability_limited_steps",
)


def read_numbers(path, texts, numbers):
    """The rows of a file as dictionaries, with these of its columns as numbers."""
    return [
        row | {name: parse(path, line, row, name, False) for name in numbers}
        for line, row in read_rows(path, (*texts, *numbers))
    ]


def read_limits(path):
    """The limit of h w of each method, predicted and measured; infinite if there is none."""
    return {
        row["method"]: tuple(math.inf if math.isnan(row[name]) else row[name] for name in LIMITS)
        for row in read_numbers(path, ("method",), LIMITS)
    }


def read_runs(path):
    """The runs of the map that have a place in it."""
    texts = ("method", "knob", "outcome")
    rows = read_numbers(path, texts, RUN_NUMBERS)
    runs = [Run(**{name: row[name] for name in (*texts, *RUN_NUMBERS)}) for row in rows]
    places = ((run, run.h_omega if run.knob == "step_size" else run.value) for run in runs)
    return [run for run, place in places if place > 0 and math.isfinite(run.amplitude)]


def read_linear(path):
    """The points (h w, damping ratio) of each method; the ratio is NaN if a step overflows."""
    linear = {}
    for row in read_numbers(path, ("method",), ("h_omega", "damping_ratio")):
        linear.setdefault(row["method"], []).append((row["h_omega"], row["damping_ratio"]))
    return linear


def read_table(path, texts, numbers, needed):
    """The rows of a file, those where `needed` is a positive number."""
    return [row for row in read_numbers(path, texts, numbers) if row[needed] > 0]


def draw(folder):
    """Draws both pictures."""
    origin = read_facts(folder / "map.json")
    limits = read_limits(folder / "limits.csv")
    runs = read_runs(folder / "map.csv")
    if runs:
        panels = OutcomeSheet(runs, {m: predicted for m, (predicted, _) in limits.items()}, origin)
        panels.draw()
        panels.sheet.save_as(folder, "stability_map")
    linear = read_linear(folder / "linear.csv")
    if linear:
        modes = read_table(folder / "modal.csv", ("method", "verdict"), MODE_NUMBERS, "omega")
        texts = ("method", "outcome")
        chosen = read_table(folder / "adaptive.csv", texts, STEP_NUMBERS, "rtol")
        damping = DampingSheet(linear, limits, modes, chosen, origin)
        damping.draw()
        damping.sheet.save_as(folder, "stability_modes")


if __name__ == "__main__":
    main(draw)
