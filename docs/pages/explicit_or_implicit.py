"""Cells of the tables of explicit and implicit methods."""

from chart_data import leaders, stiffness_ratio
from page_data import NOTHING, row, seconds

RATIOS = [(10.0**n, str(10**n) if n < 2 else f"1e{n}") for n in range(9)]
ACCURACIES = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
KINDS = ["explicit", "implicit", "split"]


def kind_at(study, ratio, wanted, kind):
    """The row of the fastest method of a kind."""
    return row(study, "kinds.csv", stiffness_ratio=ratio, accuracy=wanted, kind=kind)


def of_kind(study, ratio, wanted, kind):
    """The fastest method of a kind and its time."""
    cell = kind_at(study, ratio, wanted, kind)
    return f"{seconds(cell['time_s'])} `{cell['method']}`" if cell["method"] else NOTHING


def wins(study, wanted, kind):
    """The ratios at which a kind of method leads before all others."""
    ahead = leaders(study, wanted).items()
    led = [stiffness_ratio(ratio) for ratio, leader in ahead if leader == kind]
    return ", ".join(led) or NOTHING
