"""The numbers of the page on failures."""

import method_pages
from page_data import figures, row, rows

WORDS = {"newton_failed": "Newton failed", "indefinite_matrix": "matrix indefinite"}


def outcome_words(outcome):
    """An outcome as the tables say it."""
    return WORDS.get(outcome, outcome)


def limit_of(method):
    """The largest stable h ω by theory; beyond all numbers where there is none."""
    return float(
        row("stability_cloth", "limits.csv", method=method)["h_omega_limit_predicted"] or 1e99
    )


def damping(mode):
    """The damping ratio of a mode and its verdict."""
    ratio = float(mode["damping_ratio_measured"])
    return f"{'0' if abs(ratio) < 1e-8 else figures(ratio)}, {mode['verdict']}"


def worst_limit():
    """The largest difference of a measured and a predicted limit, relative to it."""
    limits = rows("stability_cloth", "limits.csv")
    return max(abs(float(limit["relative_difference"] or 0)) for limit in limits)


def worst_damping():
    """The largest difference of a measured and a predicted damping ratio of a hand-written method."""
    methods = method_pages.all_methods()
    hand = [m.name for m in methods if m.entry["family"] == "hand-written"]
    ratios = [
        (mode["damping_ratio_predicted"], mode["damping_ratio_measured"])
        for mode in rows("stability_cloth", "modal.csv", method=hand)
    ]
    return max(abs(float(p) - float(m)) for p, m in ratios if p and m)
