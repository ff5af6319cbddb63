"""The page's answers: at each accuracy the fastest run, by what margin, and why there is none."""

import itertools
import math

from style import family_look
from study_folder import look

# A study that was not asked for accuracies answers at these.
USUAL = tuple(10.0**-digit for digit in range(2, 9))
NEAR_ITS_LIMIT = "its limit of stability"  # as the record words it
ON_LIMITS = (
    "A step that is near its limit of stability at the start may blow up in a longer run: take half"
    " of it there."
)


def answer(row):
    """The answer of one row of the record, as the page's data has it."""
    following = {"point": row["runner_up"], "ratio": row["ratio"]}
    return {
        "accuracy": row["accuracy"],
        "point": row["point"],
        "next": None if row["runner_up"] is None else following,
        "others": [
            other | {"family": family_look(other["family"]).title} for other in row["others"]
        ],
        "warning": "; ".join(row["warnings"]) or None,
        "why": row["why_empty"],
    }


def runs_of_answers(found):
    """The answers in lists: one for each run that is the fastest at several accuracies in turn, or
    reason that there is none."""
    groups = itertools.groupby(found, lambda one: (one["point"], one["why"]))
    return [list(group) for _, group in groups]


def answers(study):
    """The answers at the accuracies that the study was asked for, or else at 1e-2, ... 1e-8."""
    rows = study.record.rows
    if not look(study.sidecar, "study", "options", "--accuracies"):
        rows = [row for row in rows if any(math.isclose(row["accuracy"], one) for one in USUAL)]
    return [answer(row) for row in rows]


def answers_note(found):
    """What a reader must know of all answers with a step near its limit; None without such."""
    warned = [answer for answer in found if NEAR_ITS_LIMIT in (answer["warning"] or "")]
    return ON_LIMITS if warned else None
