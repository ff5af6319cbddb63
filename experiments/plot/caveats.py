"""What a reader must know of a study and its motion before the errors, in sentences."""

import math

from style import number, seconds


def caveats(reference, interruption, is_work=False):
    """The sentences, two lines each: `reference` as measurements.read_reference gives it, by what
    the study was interrupted, if it was, and whether its times are counts times costs."""
    return [
        *([WORK] if is_work else []),
        *([interruption_in_words(interruption)] if interruption else []),
        *([horizon_in_words(reference)] if reference.horizon else []),
        *([symmetry_in_words(reference)] if reference.symmetric_until is not None else []),
    ]


WORK = (
    "Times are not measured: they are counts of forces, stiffness matrices, factorisations and"
    " solves,\ntimes what each of these takes on one machine. Other work of a step is not counted."
)


def interruption_in_words(interruption):
    """That points are missing, and how they are measured."""
    return (
        f"The study was interrupted by {interruption}: points are missing.\n"
        "The same command with --resume measures them."
    )


def symmetry_in_words(reference):
    """That the motion exists in exact symmetry alone, and what its errors are then."""
    return (
        "this motion exists only in exact symmetry: a push of one rounding out of it moves the"
        f" nodes apart from t = {number(reference.symmetric_until)} s on.\n"
        "Errors are those of computing the symmetric motion, from which any push leads away."
    )


def horizon_in_words(reference):
    """What is chaotic, and from when on."""
    words = (
        f"chaotic: from t = {number(reference.horizon)} s on, two runs that start one rounding apart"
        f" differ by more than 1e-2"
    )
    if reference.lyapunov:
        words += f" (× 10 in {seconds(math.log(10) / reference.lyapunov)})"
    words += f".\nPosition errors at T = {number(reference.until)} s mean nothing."
    if reference.modal_floor:
        words += " Fastest: of the runs whose energy is in the right modes."
    return words
