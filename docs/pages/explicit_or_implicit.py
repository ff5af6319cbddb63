"""Cells of the tables of explicit and implicit methods."""

from chart_data import leaders, leads_from, leads_to
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


def label(ratio):
    """A measured ratio as the tables say it."""
    return dict(RATIOS).get(ratio, NOTHING)


def change_of_lead(study, wanted):
    """The ratio up to which explicit methods lead before implicit ones, and that from which on the
    latter do."""
    both = {"kinds": ["explicit", "implicit"]}
    last = leads_to(study, wanted, "explicit", **both)
    first = leads_from(study, wanted, "implicit", **both)
    return f"{label(last)} / {label(first)}"


def wins(study, wanted, kind):
    """The ratios at which a kind of method leads before all others."""
    led = [label(ratio) for ratio, leader in leaders(study, wanted).items() if leader == kind]
    return ", ".join(led) or NOTHING
