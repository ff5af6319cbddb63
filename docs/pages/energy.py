"""The table of verdicts on long runs, and what explains its cells."""

from energy_words import energy_in_words
from page_data import row

FIXED = (
    "symplectic_euler", "verlet", "blanes_moan4", "kahan_li8", "takahashi_imada4", "symmetric4",
    "symmetric6", "symmetric8", "symmetric10", "linear_midpoint", "implicit_midpoint", "trapezoidal",
    "discrete_gradient", "rk4", "generalized_alpha", "implicit_euler",
)  # fmt: skip
ADAPTIVE = ("dprkn8", "cvode_bdf")
# A verdict as the table has it, a part that only its cells have, and what it means.
VERDICTS = (
    ("bounded, ± x", "bounded", "no drift; the error oscillates by x"),
    ("round-off", "round-off", "no more than rounding can make"),
    ("undecided, ± x", "undecided",
     "a drift, or a slow oscillation that the run is too short to tell from one"),
    ("widens at x/s", "widens", "an oscillation that grows"),
    ("drifts, x/s", "drifts", "a drift of x per second"),
    ("damped, ζ = x", "damped", "more than a tenth is lost, as a damping ratio of x does"),
    ("grows, x/s", "grows", "the energy grows exponentially at the rate x"),
    ("blows up at t", "blows up", "the error exceeds ten times the kinetic energy at the time t"),
    ("x, then …", ", then",
     "the error changed at first: the verdict is of the rest, and x is the error at the end"),
    ("too short to tell: …, t run", "too short",
     "the time limit ended the run at t, before half of it was done"),
)  # fmt: skip


def verdict_rows():
    """The rows of the table: the method, what is added to its name, and its verdict on each scene."""
    kinds = (
        (FIXED, "", {}, "drift_cloth_longer"),
        (ADAPTIVE, ", rtol 1e-6", {"value": 1e-6}, "drift_cloth"),
    )
    found = []
    for methods, addition, where, cloth in kinds:
        for method in methods:
            runs = [
                row(study, "summary.csv", method=method, **where)
                for study in ("drift_fpu", "drift_orbit", cloth)
            ]
            found.append((method, addition, [energy_in_words(run) for run in runs]))
    return found


def verdicts_of(rows):
    """The verdicts that cells of these rows have, each with what it means."""
    cells = [cell for _, _, cells in rows for cell in cells]
    return [(words, meaning) for words, sign, meaning in VERDICTS if any(sign in c for c in cells)]
