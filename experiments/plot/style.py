"""Colours, markers, line styles and number words shared by the pictures of the experiments."""

import math
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Context

import matplotlib
from matplotlib import ticker
from matplotlib.colors import to_hex, to_rgb

# Warm and cool colours: the two families differ in hue as well as in line and marker. Neighbours in
# either list differ in lightness, so that colour-blind readers can tell them apart.
WARM = ("#D55E00", "#000000", "#E69F00", "#882255", "#CC79A7", "#7F6A1F")
COOL = ("#0072B2", "#009E73", "#56B4E9", "#332288", "#44AA99", "#5D7A99")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")

# Halves go up, as in the scripts of a page, which must spell the same.
FOUR_DIGITS = Context(prec=4, rounding=ROUND_HALF_UP)

INK = "#222222"
FAINT = "#666666"
GRID = "#E4E4E4"
FRONT = "#F5E663"

SETTINGS = {
    # Verdana is as wide as DejaVu Sans and stands in for it where an SVG is shown without it.
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Verdana"],
    "font.size": 10,
    "text.color": INK,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "hatch.linewidth": 0.6,
    "xtick.color": INK,
    "ytick.color": INK,
    # Text stays text, and the same numbers give the same file.
    "svg.fonttype": "none",
    "svg.hashsalt": "qddot",
}


@dataclass(frozen=True)
class Family:
    """How all methods of one family are drawn."""

    title: str
    colors: tuple
    line: object
    filled: bool
    width: float = 1.6


FAMILIES = {
    "hand-written": Family("hand-written", WARM, "-", True),
    "sundials": Family("SUNDIALS", COOL, (0, (4, 1.8)), False),
}
# A method of SUNDIALS with SUNDIALS' own matrix and solver: in that method's colour, dotted.
STOCK = Family("its stock way, KLU", COOL, (0, (1, 1.4)), False, 1.1)


def family_look(name):
    """The look of a family; a family that is not known yet is dotted, under its own name."""
    return FAMILIES.get(name) or Family(name or "other", COOL[::-1], (0, (1, 1.5)), True)


@dataclass(frozen=True)
class Look:
    """How one method is drawn."""

    color: str
    marker: str
    family: Family

    @property
    def text_color(self):
        """The colour for letters: dark enough to be read on white."""
        rgb = to_rgb(self.color)
        luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
        return to_hex([c * min(1.0, 0.42 / max(luminance, 1e-9)) for c in rgb])

    def marker_style(self, size=None):
        """The keyword arguments of a matplotlib line that draw the marker."""
        size = size or 5.5 * min(1.0, self.family.width / 1.4)
        face = self.color if self.family.filled else "white"
        return {
            "marker": self.marker,
            "markersize": size,
            "markerfacecolor": face,
            "markeredgecolor": self.color,
            "markeredgewidth": 1.2,
        }


def assign_looks(methods):
    """A look for each method of {name: (family, stock_of)}, by its place in its family.

    Colours and markers advance together; their counts have no common divisor, so a pair comes
    back only after their product (42 methods of one family). A stock way looks like the method
    it belongs to, but for its line.
    """
    seen = {}
    looks = {}
    for method, (name, stock_of) in methods.items():
        if stock_of in looks:
            own = looks[stock_of]
            looks[method] = Look(own.color, own.marker, STOCK)
            continue
        index = seen.get(name, 0)
        seen[name] = index + 1
        family = family_look(name)
        color = family.colors[index % len(family.colors)]
        looks[method] = Look(color, MARKERS[index % len(MARKERS)], family)
    return looks


def short_names(methods):
    """The names; a name that begins with the same two words as the one before loses these."""
    short = []
    for before, method in zip([None, *methods], methods):
        words, others = method.split("_"), before.split("_") if before else []
        begins_alike = len(words) > 2 and words[:2] == others[:2]
        short.append("…_" + "_".join(words[2:]) if begins_alike else method)
    return short


def use_style():
    """Sets matplotlib up for a picture written to a file."""
    matplotlib.use("Agg")
    matplotlib.rcParams.update(SETTINGS)


def log_ticks(axis, most=8, words=None, **places):
    """At most so many ticks at the decades of a logarithmic axis, or at these places between them.
    `words` makes words of numbers, by default powers of ten."""
    words = words or power_of_ten
    axis.set_major_locator(ticker.LogLocator(numticks=most, **places))
    axis.set_minor_locator(ticker.NullLocator())
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: words(value)))


def decades(axes, across, up, font_size):
    """Logarithmic axes with a light grid; across and up make words of the numbers on them."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    log_ticks(axes.xaxis, 14, across)
    log_ticks(axes.yaxis, 14, up)
    axes.grid(True, color=GRID)
    axes.tick_params(length=3, color=FAINT, labelsize=font_size)


def number(value):
    """A number in few characters: 2e-3, 0.5, 3.3e-14."""
    if 0.1 <= abs(value) < 1000:
        return f"{value:.3g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"


def exact(value):
    """A number to the four digits by which values of a knob are told apart: 5.917e-4, 0.02."""
    rounded = float(FOUR_DIGITS.create_decimal_from_float(value))
    if rounded == 0 or abs(rounded) >= 1e-3:
        return f"{rounded:.15g}"
    mantissa, exponent = f"{rounded:.3e}".split("e")
    return f"{mantissa.rstrip('0').removesuffix('.')}e{int(exponent)}"


def power_of_ten(value):
    """The number at a decade tick: 1e-3, 1, 10."""
    exponent = round(math.log10(value))
    return {0: "1", 1: "10"}.get(exponent, f"1e{exponent}")


def widened(low, high, decades):
    """A range of positive numbers, widened to both sides where it is shorter than that."""
    factor = 10 ** (max(0.0, decades - math.log10(high / low)) / 2)
    return low / factor, high * factor


def seconds(value):
    """A duration with its unit: 20 µs, 5 ms, 3 s."""
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6), ("ns", 1e-9)):
        if value >= 0.9999 * scale or unit == "ns":
            return f"{value / scale:.3g} {unit}"
