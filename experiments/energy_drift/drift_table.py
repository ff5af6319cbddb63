"""The verdicts on where methods' energy goes, in a table by fate."""

import math

from measurements import optional
from style import COOL, FAINT, INK, WARM, number

# The two columns of the table: their left ends and widths, and where numbers begin in them.
LEFTS, COLUMN_WIDTH, NUMBERS = (0.25, 4.7), 4.1, 1.95
ROW, HEADING, GROUP_GAP = 0.172, 0.26, 0.1
FONT_SIZE = 9

# The fates in the order of the table: title, what the number beside a method is, colour, the column
# of that number.
FATES = {
    "round_off": ("nothing but round-off", "error at the end", COOL[3], "energy_error_end"),
    "bounded": ("bounded: no drift", "oscillation", COOL[0], "oscillation"),
    "undecided": ("undecided: may wander", "oscillation", COOL[2], "oscillation"),
    "widens": ("oscillates ever more widely", "1/s", WARM[3], "widening"),
    "drifts": ("drifts", "1/s", WARM[2], "drift_rate"),
    "dissipates": ("dissipates", "damping ratio", WARM[4], "damping_ratio"),
    "grows": ("gains energy", "rate in 1/s", WARM[0], "exponential_rate"),
    "blows_up": ("blows up", "when", WARM[1], "blow_up_time"),
    "unknown": ("too short to tell", "", FAINT, None),
}


def label(row):
    """The name of a run, with the tolerance of an adaptive one."""
    name = row["method"]
    return f"{name} {number(float(row['value']))}" if row["knob"] == "rtol" else name


def measure(row):
    """The number that says most of a run of its fate."""
    column = FATES[row["fate"]][3]
    return optional(row[column]) if column else math.nan


def measure_words(row):
    """The same in words, with what is known of its interval."""
    value = measure(row)
    if math.isnan(value):
        return ""
    if row["fate"] == "drifts":
        half = (float(row["drift_rate_high"]) - float(row["drift_rate_low"])) / 2
        digit = float(f"{half:.0e}")
        return f"{number(value)} ± {number(digit)} /s"
    if row["fate"] == "blows_up":
        rate = optional(row["exponential_rate"])
        return f"at {number(value)} s" + ("" if math.isnan(rate) else f", {number(rate)} /s")
    if row["fate"] in ("grows", "widens"):
        return f"{number(value)} /s"
    if row["fate"] == "dissipates":
        return f"ζ = {number(value)}"
    return f"± {number(abs(value))}"


def groups_of(rows):
    """The rows by fate, in order, those of one fate by size."""
    for fate in FATES:
        own = [row for row in rows if row["fate"] == fate]
        if own:
            own.sort(key=lambda row: abs(measure(row)) if measure(row) == measure(row) else 0)
            if fate == "blows_up":
                own.reverse()
            yield fate, own


def group_height(own):
    """The height of a group in inches."""
    return HEADING + ROW * len(own) + GROUP_GAP


def columns_of(rows):
    """The groups in two columns, as even as they can be."""
    groups = list(groups_of(rows))
    splits = [(groups[:count], groups[count:]) for count in range(1, len(groups) + 1)]
    return min(splits, key=lambda split: max(map(column_height, split)))


def column_height(groups):
    """The height of some groups in inches."""
    return sum(group_height(own) for _, own in groups)


def table_height(rows):
    """The height in inches."""
    return max(map(column_height, columns_of(rows)))


def draw_table(sheet, top, rows, until):
    """The verdicts."""
    for left, groups in zip(LEFTS, columns_of(rows)):
        line = top
        for fate, own in groups:
            draw_group(sheet, left, line, fate, own, until)
            line += group_height(own)


def draw_group(sheet, left, top, fate, own, until):
    """The verdicts of one fate."""
    middle = {"va": "center", "size": FONT_SIZE}
    title, meaning, color, _ = FATES[fate]
    bar = sheet.axes(left, top, 0.07, HEADING + ROW * len(own))
    bar.set_axis_off()
    bar.axvspan(0, 1, color=color)
    line = top + HEADING / 2
    right = {"color": FAINT, "ha": "right"} | middle
    sheet.text(left + 0.17, line, f"{title} ({len(own)})", color=color, weight="bold", **middle)
    sheet.text(left + COLUMN_WIDTH, line, meaning, **right)
    top += HEADING
    for row in own:
        line = top + ROW / 2
        sheet.text(left + 0.17, line, label(row), color=INK, **middle)
        sheet.text(left + NUMBERS, line, measure_words(row), color=INK, **middle)
        sheet.text(left + COLUMN_WIDTH, line, remark(row, until), **right)
        top += ROW


def remark(row, until):
    """How far the run came, where that is not the end."""
    outcome = row["outcome"]
    if outcome == "reached_end" or row["fate"] == "blows_up":
        settled = row["has_settled"] == "yes"
        return f"from {number(float(row['settled_from']))} s on" if settled else ""
    part = float(row["t_reached"]) / until
    percent = f"{100 * part:.2g} %"
    if row["fate"] == "unknown" and row["fate_so_far"] != "unknown":
        return f"{row['fate_so_far'].replace('_', ' ')} in {percent} of t"
    return f"{percent} of t" if outcome == "over_budget" else f"{outcome} at {percent}"
