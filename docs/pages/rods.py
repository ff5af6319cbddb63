"""The numbers of the page on rods."""

from dataclasses import dataclass

from chart_data import of_kind, stiffness_ratio
from page_data import figures, rows


@dataclass(frozen=True)
class Ratio:
    """A stiffness ratio and its words."""

    value: float
    words: str


@dataclass(frozen=True)
class Change:
    """What rods change at a ratio, in words."""

    ratio: str
    change: str


def ratios():
    """The ratios of the study."""
    found = sorted({float(cell["stiffness_ratio"]) for cell in rows("crossover_hem", "kinds.csv")})
    return [Ratio(value, stiffness_ratio(value)) for value in found]


def changes():
    """What rods change at each ratio."""
    return [
        Change(stiffness_ratio(float(row["stiffness_ratio"])), figures(row["change"], 2))
        for row in rows("crossover_hem", "rods.csv")
    ]
