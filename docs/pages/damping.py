"""The numbers of the page on damping."""

import math

import method_pages
from page_data import figures, row, rows

ZETAS = ["0.01", "0.1", "0.3", "1", "3", "10"]
CROSSOVERS = [
    ("crossover_damped_0", "ζ = 0"),
    ("crossover_damped_01", "ζ = 0.1"),
    ("crossover_damped_1", "ζ = 1"),
    ("crossover_damped_10", "ζ = 10"),
]
CHARTS = [
    ("damped_cloth_01", "The cloth, ζ = 0.1"),
    ("damped_cloth_1", "The cloth, ζ = 1"),
    ("damped_chain_01", "The chain, ζ = 0.1"),
    ("damped_chain_1", "The chain, ζ = 1"),
    ("plucked_string_01", "A plucked string, ζ = 0.1"),
    ("plucked_string_1", "A plucked string, ζ = 1"),
]

MODAL_METHODS = [
    "verlet",
    "symmetric4",
    "rk4",
    "linear_midpoint",
    "generalized_alpha",
    "trbdf2",
    "bdf2",
    "implicit_euler",
]


def modes_shown():
    """The modes with a damping of their own: frequency, damping ratio and those by the methods."""
    shown = []
    for mode in rows("damped_modes", "modal.csv", method=MODAL_METHODS[0]):
        if float(mode["damping_ratio_physical"]) < 1e-3:
            continue
        measured = [
            row("damped_modes", "modal.csv", method=method, mode=mode["mode"])
            for method in MODAL_METHODS
        ]
        shown.append(
            {
                "frequency": figures(float(mode["omega"]) / (2 * math.pi), 3),
                "physical": figures(mode["damping_ratio_physical"], 3),
                "ratios": [figures(one["damping_ratio_measured"], 3) for one in measured],
            }
        )
    return shown


def worst_order_gap():
    """The largest difference of an observed order from that of theory, of orders above 1."""
    gaps = []
    for method in method_pages.all_methods():
        observed = [
            float(one["observed_order"])
            for one in rows("damped_convergence", "order.csv", method=method.name)
            if one["observed_order"]
        ]
        if observed and method.order > 1:
            gaps.append(abs(observed[-1] - method.order))
    return max(gaps)


def limit(method, zeta):
    """The largest stable h ω of a method at a damping ratio, as measured; rkc takes more stages
    where steps are longer."""
    found = row("damped_limits", "damped_limits.csv", method=method, damping_ratio=float(zeta))
    measured = found["h_omega_limit_measured"]
    return figures(measured, 3) if measured else "no limit"


def worst_damped_limit():
    """The largest difference of a measured limit from its formula, relative to it."""
    limits = rows("damped_limits", "damped_limits.csv")
    return max(abs(float(limit["relative_difference"] or 0)) for limit in limits)


def _hand_written(implicit):
    return [
        m.name
        for m in method_pages.all_methods()
        if m.entry["family"] == "hand-written" and m.entry["implicit"] == implicit
    ]


def explicit_methods():
    """The hand-written explicit methods."""
    return _hand_written("no")


def implicit_methods():
    """The hand-written implicit methods."""
    return _hand_written("yes")
