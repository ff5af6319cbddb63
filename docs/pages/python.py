"""Cells of the tables beside SciPy."""

from page_data import NOTHING, figures, rows, seconds

# Ways in the first table: label, rows of times.csv, whether its ratio is shown, whether it can do the
# planet.
NUMPY_LOOP = {"force": "own f", "way": "NumPy"}
WAYS = [
    ("`solve_ivp`, DOP853", {"force": "own f", "way": "solve_ivp", "method": "DOP853"}, True, True),
    ("`solve_ivp`, LSODA", {"force": "own f", "way": "solve_ivp", "method": "LSODA"}, True, True),
    (
        "`solve_ivp`, Radau or BDF with a sparse K, the faster one",
        {"force": "own f", "way": "solve_ivp", "method": ["Radau", "BDF"]},
        True,
        True,
    ),
    ("Verlet's method, a loop in NumPy", NUMPY_LOOP, True, True),
    ("qddot, the same force in NumPy", {"force": "own f", "way": "qddot"}, False, True),
    ("qddot, the force by Numba", {"force": "own f, Numba", "way": "qddot"}, False, True),
    (
        "qddot, the scene itself",
        {"force": "the scene's f", "way": "qddot", "remark": ""},
        False,
        False,
    ),
    (
        "qddot, the scene by `accuracy=`",
        {"force": "the scene's f", "way": "qddot", "remark": "chosen by itself"},
        False,
        False,
    ),
]


def time_of(problem, accuracy, way, shows_ratio):
    """The least time of a way to an accuracy and, if asked for, how many times ours that is."""
    found = rows("beside_scipy", "times.csv", problem=problem, accuracy=accuracy, **way)
    if not found:
        return "not reached"
    best = min(found, key=lambda row: float(row["time_s"]))
    return seconds(best["time_s"]) + (f" ({figures(best['ratio'])})" if shows_ratio else "")


def lines_of(way):
    """How many lines of code a way takes."""
    return rows("beside_scipy", "times.csv", **way)[0]["lines"]


def ratio_of(accuracy, way):
    """How many times ours the time of a way is on the cloth."""
    found = rows("beside_scipy", "times.csv", problem="cloth", accuracy=accuracy, **way)
    return "".join(figures(row["ratio"]) for row in found) or NOTHING
