"""The strip under a work-precision chart. It says for each cause of failure how many methods have
failed runs, and at which values of their knobs."""

from emphasis import SHOWS_ALL
from failures import FONT_SIZE, KNOBS, TITLE
from scene_row import counted
from style import FAINT, number

LINE = 0.2
FOOT = 0.1
# Rarer causes share one line.
MOST_CAUSES = 4
MARGIN = 0.15
COUNT_AT = 1.75
WHERE_AT = 2.75


def threshold(sweep, cause):
    """The value at which a sweep starts to fail: ("≥", value) or ("≤", value) if runs of this cause
    are at one end of it. ("", value) if good runs are on both sides."""
    values = [run.value for run in sweep if run.failure == cause]
    good = [run.value for run in sweep if not run.failure]
    if min(values) > max(good):
        return "≥", min(values)
    if max(values) < min(good):
        return "≤", max(values)
    return "", values[0]


def where(groups, cause, named):
    """The values of the knobs, in words, at which methods with some points fail for a cause. Named
    are the least and the largest limit, with or without their methods."""
    ends = {}
    for knob, group in groups.items():
        symbol = KNOBS.get(knob, ("", knob))[1]
        for sweep in group:
            failures = {run.failure for run in sweep}
            if failures.issuperset(("", cause)):
                sign, value = threshold(sweep, cause)
                ends.setdefault((symbol, sign), []).append((value, sweep[0].method))

    def limit(value, method):
        return f"{number(value)} ({method})" if named else number(value)

    parts = []
    for (symbol, sign), limits in ends.items():
        low, high = min(limits), max(limits)
        if number(low[0]) != number(high[0]):
            words = f"{limit(*low)} to {limit(*high)}"
        else:  # no single method's, unless there is only one
            words = limit(*low) if len(limits) == 1 else number(low[0])
        parts.append(f"{symbol} {sign} {words}" if sign else f"some {symbol} between")
    return "; ".join(parts)


def shortening(names):
    """Lists of fewer and fewer of the names, from all to the first, and how many more there are."""
    shorter = [
        f"{', '.join(names[:count])} and {len(names) - count} more"
        for count in range(len(names) - 1, 0, -1)
    ]
    return [", ".join(names), *shorter]


def lines(groups):
    """The lines of the strip: the cause, the names of its methods, and sentences on it from the
    fullest to the shortest."""
    sweeps = [sweep for group in groups.values() for sweep in group]
    methods = {}
    for sweep in sweeps:
        for run in sweep:
            methods.setdefault(run.failure, {})[sweep[0].method] = None
    drawn = methods.pop("", {})
    causes = sorted(methods, key=lambda cause: -len(methods[cause]))
    found = []
    absent = [name for name in dict.fromkeys(s[0].method for s in sweeps) if name not in drawn]
    if absent:
        found.append(("no point at all", absent, shortening(absent)))
    for cause in causes[:MOST_CAUSES]:
        names = list(methods[cause])
        words = [where(groups, cause, named) for named in (True, False)]
        found.append((cause, names, words if words[0] else shortening(names)))
    others = causes[MOST_CAUSES:]
    if others:
        names = dict.fromkeys(name for cause in others for name in methods[cause])
        found.append(("other causes", list(names), shortening(others)))
    return found


def strip_height(groups):
    """The height of the strip in inches."""
    return TITLE + LINE * len(lines(groups)) + FOOT if groups else 0.0


def draw_strip(sheet, top, groups, looks):
    """The whole strip, its upper edge at `top` inches under the upper edge of the sheet; `looks` has
    all methods of the study."""
    sheet.rule(top)
    sheet.text(MARGIN, top + 0.2, "Runs without a point above", size=10, weight="bold", va="center")
    failing = len({sweep[0].method for group in groups.values() for sweep in group})
    note = f"{failing} of {counted(len(looks), 'method')}; {SHOWS_ALL} shows each"
    edge = {"size": FONT_SIZE, "color": FAINT, "ha": "right", "va": "center"}
    sheet.text(sheet.width - MARGIN, top + 0.2, note, **edge)
    for line, (cause, names, words) in enumerate(lines(groups)):
        middle = top + TITLE + LINE * (line + 0.5)
        style = {"size": FONT_SIZE, "va": "center"}
        sheet.text(MARGIN, middle, cause, **style)
        sheet.text(COUNT_AT, middle, counted(len(names), "method"), **style)
        sheet.fitting(WHERE_AT, middle, words, sheet.width - MARGIN, **style, color=FAINT)
