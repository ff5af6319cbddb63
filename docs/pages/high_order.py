"""The numbers of the page on symmetric multistep methods."""

import chart_data
import method_pages
import page_data

HIGH = ["symmetric4", "symmetric6", "symmetric8", "symmetric10", "takahashi_imada4"]
NEAR = 0.2  # rad between roots of the formula


def others():
    """The explicit hand-written methods that are not of this page."""
    return [
        method.name
        for method in method_pages.all_methods()
        if method.entry["family"] == "hand-written"
        and not method.has("implicit")
        and not method.has("needs_split")
        and method.name not in [*HIGH, "exact"]
    ]


def gain(study, wanted):
    """The least time to an accuracy without the methods of this page and, where these are faster, with
    them."""
    before = chart_data.fastest(study, wanted, of=others())
    after = chart_data.fastest(study, wanted, of=others() + HIGH)
    if not after:
        return page_data.NOTHING
    if after.method in others():
        return f"{before.time}, stays"
    return f"{before.time if before else 'not reached'} → {after.time} `{after.method}`"


def formulas():
    """The sample of formulas, those that are methods left out."""
    return page_data.rows("symmetric_roots", "roots.csv", method="")


def swinging(is_near):
    """The part of the stable formulas with near, or with separate, roots whose energy swings by a tenth
    or more."""
    swings = [
        float(formula["energy_swing"]) >= 0.1
        for formula in formulas()
        if formula["gap"] and (float(formula["gap"]) < NEAR) == is_near
    ]
    return sum(swings) / max(len(swings), 1)


def stable_formulas():
    """How many formulas of the sample have a gap, and so are stable."""
    return sum(bool(formula["gap"]) for formula in formulas())


def of_order_12(least_gap=0):
    """The formula of order 12 with the largest limit, of those with at least this gap between roots."""
    found = [f for f in formulas() if f["steps"] == "12" and float(f["gap"] or 0) >= least_gap]
    return max(found, key=lambda formula: float(formula["limit"]))
