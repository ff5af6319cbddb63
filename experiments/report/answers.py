"""The answer at each accuracy: which run is the fastest, by what margin, and why there is none."""

import math

from failures import KNOBS
from methods_part import family_title
from style import exact
from study_folder import digits

ACCURACIES = tuple(10.0**-digit for digit in range(2, 9))
# A step that is nearer to its limit is warned of.
SMALL_MARGIN = 0.15
NEAR_ITS_LIMIT = "its limit of stability"
ON_LIMITS = (
    "A step that is near its limit of stability at the start may blow up in a longer run: take half"
    " of it there."
)


def knob_in_words(knob, value):
    """A value of a knob: "h = 5.917e-4 s", "rtol = 1e-6"."""
    unit = " s" if knob == "step_size" else ""
    symbol = KNOBS.get(knob, ("", knob.replace("_", " ")))[1]
    return f"{symbol} = {exact(value)}{unit}"


def is_timed(run):
    """Whether the run reached the end and its time is known."""
    return run.outcome == "reached_end" and 0 < run.time < math.inf


def fastest_by_method(runs, accuracy):
    """The fastest of each method's runs whose error is known to be at most the accuracy, as indices
    into runs, the fastest method first."""
    fastest = {}
    for index, run in enumerate(runs):
        if not (is_timed(run) and run.counts and run.bound <= accuracy):
            continue
        if run.method not in fastest or run.time < runs[fastest[run.method]].time:
            fastest[run.method] = index
    # A tie is the first row's, as it is in front.csv.
    return sorted(fastest.values(), key=lambda index: (runs[index].time, index))


def may_be_reached(run, accuracy):
    """Whether the run's error may be at most the accuracy, for all that is known."""
    least = run.known[0] if run.known else run.error
    return is_timed(run) and run.counts and least <= accuracy


def why_empty(runs, accuracy, certified):
    """Why no run is known to have reached an accuracy."""
    if certified is not None and certified > accuracy:
        return "beyond what the reference certifies"
    if any(may_be_reached(run, accuracy) for run in runs):
        return "no method is known to have reached it"
    return "no method reached it"


def behind(runs, index, best):
    """A run that is not the fastest, and how many times as long it takes."""
    return {"point": index, "ratio": runs[index].time / runs[best].time}


def best_of_other_families(runs, ranked):
    """The fastest run of each family but the best one's, the fastest first."""
    seen = {runs[ranked[0]].family}
    others = []
    for index in ranked:
        if runs[index].family not in seen:
            seen.add(runs[index].family)
            family = family_title(runs[index].family)
            others.append({"family": family} | behind(runs, index, ranked[0]))
    return others


def warning(run, margin, certified):
    """What a reader must know of the run that is named, in few words; None where there is
    nothing."""
    warnings = []
    if margin is not None and margin < SMALL_MARGIN:
        side = "above" if margin < 0 else "below"
        warnings.append(f"{abs(100 * margin):.2g} % {side} {NEAR_ITS_LIMIT}")
    if certified is not None and certified > 0.1 * run.error:
        warnings.append(f"error known only to within {certified:.1e}, as the reference itself is")
    return "; ".join(warnings) or None


def answer(study, runs, accuracy):
    """The answer at one accuracy, as the page's data has it."""
    ranked = fastest_by_method(runs, accuracy)
    empty = {"accuracy": accuracy, "point": None, "next": None, "others": [], "warning": None}
    if not ranked:
        return empty | {"why": why_empty(runs, accuracy, study.certified)}
    best, *others = ranked
    run = runs[best]
    margin = study.margins.get((digits(accuracy), run.method, run.value))
    return empty | {
        "point": best,
        "why": None,
        "next": behind(runs, others[0], best) if others else None,
        "others": best_of_other_families(runs, ranked),
        "warning": warning(run, margin, study.certified),
    }


def answers(study):
    """The answers at the accuracies that the study was asked for, or else at 1e-2, ... 1e-8, by the
    error that it is judged by."""
    runs = study.judged_runs()
    accuracies = study.accuracies or ACCURACIES
    return [answer(study, runs, accuracy) for accuracy in accuracies]


def answers_note(found):
    """What a reader must know of all answers with a step near its limit; None without such."""
    warned = [answer for answer in found if NEAR_ITS_LIMIT in (answer["warning"] or "")]
    return ON_LIMITS if warned else None
