"""The strip under a work-precision chart that shows the runs which are no points of it."""

from measurements import grouped
from style import FAINT, GRID, log_ticks, number, widened

KNOBS = {"step_size": ("step size h", "h"), "rtol": ("tolerance rtol", "rtol")}
TITLE = 0.36
ROW = 0.17
HEADING = 0.26
GROUP_GAP = 0.08
NAMES_END = 1.95
SWEEP_END = 4.75
REASON_START = 4.92
FONT_SIZE = 9


def failing(sweeps):
    """The sweeps with at least one failed run, grouped by knob."""
    failed = (sweep for sweep in sweeps if any(run.failure for run in sweep))
    return grouped(failed, lambda sweep: sweep[0].knob)


def group_height(group):
    """The height of the rows of one knob in inches, with their heading."""
    return HEADING + ROW * len(group) + GROUP_GAP


def strip_height(groups):
    """The height of the strip in inches."""
    return TITLE + sum(map(group_height, groups.values())) if groups else 0.0


def span_in_words(values, all_values, symbol):
    """Where in a sweep some values lie: one end of it, one run of neighbours or single places."""
    lowest, highest = min(values), max(values)
    between = [value for value in all_values if lowest <= value <= highest]
    if len(all_values) == len(values) > 1:
        return f"every {symbol}"
    if len(between) > len(values) or len(all_values) == 1:
        return f"{symbol} = " + ", ".join(map(number, values))
    if highest == all_values[-1]:
        return f"{symbol} ≥ {number(lowest)}"
    if lowest == all_values[0]:
        return f"{symbol} ≤ {number(highest)}"
    if number(lowest) == number(highest):
        return f"{symbol} = {number(lowest)}"
    return f"{number(lowest)} ≤ {symbol} ≤ {number(highest)}"


def reasons(sweep, symbol):
    """The failures of a sweep in words, from all that is known to the mere count."""
    where = {}
    for run in sweep:
        if run.failure:
            where.setdefault(run.failure, []).append(run.value)
    all_values = [run.value for run in sweep]
    spans = {why: span_in_words(values, all_values, symbol) for why, values in where.items()}
    yield "; ".join(f"{why} at {span}" for why, span in spans.items())
    yield "; ".join(f"{why} {len(values)}×" for why, values in where.items())
    yield f"{sum(map(len, where.values()))} runs failed in {len(where)} different ways"


def write_name(sheet, middle, words, color):
    """Writes what stands before a row."""
    left = NAMES_END - 0.12
    sheet.text(left, middle, words, size=FONT_SIZE, color=color, ha="right", va="center")


def draw_sweep(axes, row, sweep, look):
    """One row of marks at the knob values: a dot for a point of the chart, a cross for none."""
    values = [run.value for run in sweep]
    axes.plot([values[0], values[-1]], [row, row], color=GRID, linewidth=0.8, zorder=1)
    good = [run.value for run in sweep if not run.failure]
    failed = [run.value for run in sweep if run.failure]
    axes.plot(good, [row] * len(good), "o", color=look.color, markersize=2.6, zorder=2)
    axes.plot(failed, [row] * len(failed), "x", color=look.color, markersize=5.5, mew=1.6, zorder=3)


def draw_group(sheet, top, knob, group, looks):
    """The sweeps over one knob, a row each, under one axis of knob values."""
    title, symbol = KNOBS.get(knob, (knob.replace("_", " "), knob))
    rows_top = top + HEADING
    height = ROW * len(group)
    axes = sheet.axes(NAMES_END, rows_top, SWEEP_END - NAMES_END, height)
    axes.set_xscale("log")
    write_name(sheet, rows_top - 0.09, title, FAINT)
    for row, sweep in enumerate(group):
        look = looks[sweep[0].method]
        middle = rows_top + ROW * (row + 0.5)
        draw_sweep(axes, row, sweep, look)
        write_name(sheet, middle, sweep[0].method, look.text_color)
        words, style = reasons(sweep, symbol), {"size": FONT_SIZE, "va": "center"}
        sheet.fitting(REASON_START, middle, words, sheet.width - 0.1, **style)
    values = [run.value for sweep in group for run in sweep]
    axes.set_xlim(*widened(min(values) / 1.6, max(values) * 1.6, 1))
    axes.set_ylim(len(group) - 0.5, -0.5)
    axes.set_yticks([])
    axes.spines[["left", "bottom"]].set_visible(False)
    axes.grid(True, axis="x")
    axes.xaxis.tick_top()
    log_ticks(axes.xaxis, 7)
    axes.tick_params(axis="x", length=0, pad=1, labelsize=FONT_SIZE, labelcolor=FAINT)


def draw_strip(sheet, top, groups, looks):
    """The whole strip, its upper edge at `top` inches under the upper edge of the sheet."""
    sheet.rule(top)
    sheet.text(0.15, top + 0.2, "Runs without a point above", size=10, weight="bold", va="center")
    note = "one row per method:  × failed   • drawn above"
    sheet.text(sheet.width - 0.15, top + 0.2, note, size=FONT_SIZE, ha="right", va="center")
    top += TITLE
    for knob, group in groups.items():
        draw_group(sheet, top, knob, group, looks)
        top += group_height(group)
