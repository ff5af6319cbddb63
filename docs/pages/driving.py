"""The numbers of the page on driven motions."""

import method_pages
from energy_words import energy_in_words
from page_data import figures, rows


def drift_verdicts():
    """Each method of the long run, with its tolerance if it has one, and its verdict."""
    found = []
    for run in rows("driven_drift", "summary.csv"):
        if float(run["value"]) in (1e-4, 1e-8) and run["method"] == "dprkn8":
            continue
        found.append((run["method"], energy_in_words(run)))
    return found


def periods():
    """The periods of the support in the long run: 1 Hz."""
    return figures(rows("driven_drift", "summary.csv")[0]["t_reached"], 3)


def _observed():
    """Observed orders and those of theory, of methods whose errors stay above rounding."""
    for method in method_pages.all_methods():
        observed = [
            float(one["observed_order"])
            for one in rows("driven_convergence", "order.csv", method=method.name)
            if one["observed_order"]
        ]
        if observed and 1 < method.order <= 4:
            yield observed[-1], method.order


def orders_shown():
    """The orders that are compared: "2 and 4"."""
    return " and ".join(str(order) for order in sorted({order for _, order in _observed()}))


def worst_driven_order_gap():
    """The largest difference of an observed order from that of theory."""
    return max(abs(observed - order) for observed, order in _observed())
