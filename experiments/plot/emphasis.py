"""How strongly a work-precision chart draws each line: the methods that stand out, or all of them."""

import os
from dataclasses import dataclass

from matplotlib.colors import to_hex, to_rgb

from prominent import looks_by_prominence, strong_methods
from record import sweeps
from style import FAINT, assign_looks, family_look

# How the caller asks for all methods: Python's module has another word for it.
SHOWS_ALL = os.environ.get("QDDOT_SHOWS_ALL", "--all")
LABEL_SIZE = 9.5
# A method stays in the background of a crowded chart if it is nowhere nearer to the front than
# this; only errors small enough to matter count.
NEAR = 3.0
MATTERS = 0.1
CROWD = 24
BACKGROUND = 0.3
# The share of a family's colour in the cloud of pale lines, and a label's cost of hiding it.
PALE = 0.22
PALE_INK = 0.15


@dataclass(frozen=True)
class Stroke:
    """How one line is drawn: keyword arguments of matplotlib for the line and its markers, size in
    points and opacity of its label. Without a label it has no size. `ink` is how much a label of
    another line minds hiding it."""

    color: str
    alpha: float
    line: dict
    marker: dict
    label_size: float | None
    label_alpha: float = 1.0
    ink: float = 1.0


def stroke_of(look, strength):
    """The stroke of a line with a name, from faint to full strength 1."""
    full = strength == 1
    return Stroke(
        look.color,
        strength,
        {
            "linestyle": look.family.line,
            "linewidth": look.family.width * (0.6 + 0.4 * strength),
            "zorder": 2.5 + 0.5 * strength,
        },
        look.marker_style(),
        LABEL_SIZE if full else 0.8 * LABEL_SIZE,
        1 if full else 0.75,
    )


def identities(runs):
    """The methods in the order of the runs, as assign_looks takes them."""
    return {run.method: (run.family, run.stock_of) for run in runs}


class Everything:
    """Every line in its colour and with its name; faint where a crowded chart has nearer ones."""

    def __init__(self, views):
        main = views[0]
        self.looks = assign_looks(identities(main.runs))
        self.shown = list(self.looks)
        self.crowded = self.is_crowded(main)

    @staticmethod
    def is_crowded(view):
        """Whether a view has so many lines that some stand back."""
        return len(sweeps(view.runs)) > CROWD

    def stroke(self, view, sweep):
        """How the line of a sweep is drawn among those of a view."""
        faint = self.is_crowded(view) and not is_near(view, sweep)
        return stroke_of(self.looks[sweep[0].method], BACKGROUND if faint else 1.0)

    def rest(self):
        """What the key says of the lines that stand back: words and how their sample looks."""
        if not self.crowded:
            return None
        words = f"faint: never within {NEAR:g} × the fastest at errors below {MATTERS:g}"
        return words, {"color": FAINT, "alpha": BACKGROUND, "linewidth": 1.2, "marker": "o"}


def is_near(view, sweep):
    """Whether some run of the sweep, of an error that matters, is near the front of the view. It
    takes at most NEAR times as long as the fastest with that error or a smaller one."""
    good = [(view.drawn_error(run), run.time) for run in view.runs if not run.failure]
    return any(
        error <= MATTERS and time <= NEAR * min(other for e, other in good if e <= error)
        for error, time in ((view.drawn_error(run), run.time) for run in sweep if not run.failure)
    )


class Prominent:
    """The methods that stand out in the first of the views in full colour and with their names, all
    others as a pale cloud."""

    def __init__(self, views):
        main = views[0]
        known = identities(main.runs)
        strong = strong_methods(main)
        self.shown = [method for method in known if method in strong]
        self.looks = looks_by_prominence(known, strong)
        drawn = {run.method for view in views for run in view.runs if not run.failure}
        self.pale = len(drawn.difference(strong))

    def stroke(self, view, sweep):
        """How the line of a sweep is drawn; the same in every view."""
        method = sweep[0].method
        if method in self.shown:
            return stroke_of(self.looks[method], 1.0)
        color = pale(family_look(sweep[0].family).colors[0])
        line = {"linestyle": "-", "linewidth": 0.8, "zorder": 2.1}
        marker = {"marker": "o", "markersize": 2.2, "markeredgewidth": 0}
        return Stroke(color, 1.0, line, marker, None, ink=PALE_INK)

    def rest(self):
        """What the key says of the pale cloud: words and how its sample looks."""
        if not self.pale:
            return None
        methods = "method" if self.pale == 1 else "methods"
        words = f"pale: {self.pale} other {methods} ({SHOWS_ALL} names them)"
        style = {"color": pale(FAINT), "linewidth": 1.2, "marker": "o", "markersize": 3}
        return words, style


def pale(color):
    """The colour, mixed with white."""
    return to_hex([1 - PALE * (1 - part) for part in to_rgb(color)])
