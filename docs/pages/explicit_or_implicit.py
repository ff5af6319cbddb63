"""Cells of the tables of explicit and implicit methods."""

from chart_data import kind_at, leaders, of_kind, stiffness_ratio
from page_data import NOTHING

RATIOS = [(10.0**n, str(10**n) if n < 2 else f"1e{n}") for n in range(9)]
ACCURACIES = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
KINDS = ["explicit", "implicit", "split"]


def wins(study, wanted, kind):
    """The ratios at which a kind of method leads before all others."""
    ahead = leaders(study, wanted).items()
    led = [stiffness_ratio(ratio) for ratio, leader in ahead if leader == kind]
    return ", ".join(led) or NOTHING
