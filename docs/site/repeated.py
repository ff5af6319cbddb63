"""A study that is measured again beside what docs/data keeps of it: each figure of its tables then and
now, and their ratio.

Times do not carry over from one processor to another. Ratios of times nearly do, so a chart's ratios
and the columns that are ratios come first.
"""

import csv
import datetime
import io
import itertools
import math
import statistics
from dataclasses import dataclass

from chart_data import read_record
from page_data import seconds, times
from processor import processor
from study import keep, write_whole

# Columns that are ratios, or numbers without a unit that a ratio leads to.
RATIOS = ("ratio", "margin", "exponent", "times_smaller", "times_faster", "part", "share")
# The settings of a run, which come after results in some tables.
SETTINGS = ("scene", "method", "knob", "value")
# A table with more figures than that is summed up by its columns.
MOST_FIGURES = 120
# So many cells with words of a column are printed then and now.
MOST_WORDS = 8


@dataclass(frozen=True)
class Figure:
    """One cell of a table, then and now; the row's key in words."""

    table: str
    column: str
    key: str
    then: str
    now: str

    @property
    def ratio(self):
        """Now over then; nan where they are no numbers or then is zero."""
        then, now = as_number(self.then), as_number(self.now)
        return now / then if then else math.nan


def as_number(cell):
    """The number of a cell; nan where it has none."""
    try:
        return float(cell)
    except ValueError:
        return math.nan


def read(path):
    """The rows of a table, as dicts of texts by column."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def key_columns(rows):
    """The columns that tell the rows of a table apart: the settings of a run, or else the first
    columns, as few as do."""
    columns = list(rows[0])
    by_run = [column for column in SETTINGS if column in columns]
    prefixes = [columns[:count] for count in range(1, len(columns) + 1)]
    has_runs = "knob" in columns and "outcome" in columns
    for chosen in [by_run] * has_runs + prefixes:
        if len({tuple(row[column] for column in chosen) for row in rows}) == len(rows):
            return chosen
    return columns


def compared(table, then, now):
    """The figures of the rows that both have, those of a ratio first, and how many rows only then and
    only now had. A column whose cells are all the same then and now has no figures."""
    if not then or not now:
        return [], len(then), len(now)
    keys = key_columns(then)
    now_at = {tuple(row[column] for column in keys): row for row in now}
    pairs = [
        (key, row, now_at[key])
        for row in then
        if (key := tuple(row[column] for column in keys)) in now_at
    ]
    columns = [column for column in then[0] if column not in keys and column in now[0]]
    columns.sort(key=lambda column: not any(word in column.split("_") for word in RATIOS))
    figures = [
        Figure(table, column, " ".join(key), old[column], new[column])
        for column in columns
        if any(old[column] != new[column] for _, old, new in pairs)
        for key, old, new in pairs
        if old[column] or new[column]
    ]
    return figures, len(then) - len(pairs), len(now) - len(pairs)


def ratio_words(ratio):
    """A ratio in two digits; a dash where there is none."""
    return times(ratio) if math.isfinite(ratio) else "–"


def figure_lines(figures):
    """A line for each figure, or where there are too many one for each column."""
    if len(figures) <= MOST_FIGURES:
        yield f"  {'now/then':>8}  {'then':>14}  {'now':>14}  figure"
        for one in figures:
            words = f"{one.then or '–':>14}  {one.now or '–':>14}  {one.column} of {one.key}"
            yield f"  {ratio_words(one.ratio):>8}  {words}"
        return
    yield f"  {'now/then':>8}  {'half of them between':>20}  {'changed':>12}  column"
    for column, own in itertools.groupby(figures, lambda one: one.column):
        own = list(own)
        changed = [one for one in own if one.then != one.now]
        ratios = [one.ratio for one in own if math.isfinite(one.ratio)]
        low, middle, high = map(ratio_words, quartiles(ratios))
        yield f"  {middle:>8}  {low:>9} {high:>10}  {len(changed):>4} of {len(own):>4}  {column}"
        if not ratios:  # words
            yield from (f"            {one.key}: {one.then}, now {one.now}" for one in changed[:MOST_WORDS])


def quartiles(values):
    """The quartiles of some numbers; nan of none."""
    if len(values) < 2:
        return [*values, math.nan][:1] * 3
    return statistics.quantiles(values, n=4, method="inclusive")


def chart_lines(then, now):
    """What a page says of a chart, at each accuracy: SUNDIALS' fastest over the fastest of all, and
    that one's time, from the folders of both."""
    views = [read_record(str(folder)).judged for folder in (then, now)]
    yield "  SUNDIALS' fastest over the fastest of all"
    yield f"  {'accuracy':>8}  {'then':>6}  {'now':>6}  the fastest then and now"
    for accuracy in views[0].ranked:
        ratios, words = [], []
        for view in views:
            ranked = view.ranked.get(accuracy) or []
            sundials = next((run.time for run in ranked if run.family == "sundials"), math.nan)
            ratios.append(ratio_words(sundials / ranked[0].time) if ranked else "–")
            words.append(f"{ranked[0].method} {seconds(ranked[0].time)}" if ranked else "none")
        yield f"  {accuracy:>8.0e}  {ratios[0]:>6}  {ratios[1]:>6}  {words[0]}, {words[1]}"


def text_lines(then, now):
    """The lines of what a program printed that are others now, each then and now."""
    pairs = itertools.zip_longest(then.splitlines(), now.splitlines(), fillvalue="")
    changed = [pair for pair in pairs if pair[0] != pair[1]]
    if not changed:
        yield "  prints the same"
    for old, new in changed:
        yield f"  then: {old}"
        yield f"  now:  {new}"


def comparison(study, repeat):
    """Lines that compare a study as docs/data keeps it with the repeat of it. Writes all figures into
    comparison.csv of the repeat's folder."""
    made = study.record
    yield f"then: {made['processor']}, {made['date']}, in {made['seconds']:g} s"
    yield f"now:  {processor()}, {datetime.date.today().isoformat()}"
    if study.text:
        yield study.text
        then = (study.data / study.text).read_text(encoding="utf-8")
        yield from text_lines(then, (repeat.folder / study.text).read_text(encoding="utf-8"))
    if "chart.json" in study.tables:
        yield "chart"
        yield from chart_lines(study.data, repeat.folder)
    every = []
    for path in sorted(study.data.glob("*.csv")):
        if path.name == study.text or not (repeat.folder / path.name).exists():
            continue
        kept = repeat.folder / "kept" / path.name
        keep(repeat.folder / path.name, kept, study.columns.get(path.name))
        figures, gone, new = compared(path.name, read(path), read(kept))
        every += figures
        rows = f", {gone} rows only then, {new} only now" if gone or new else ""
        yield f"{path.name}{rows}{'' if figures else ': all figures are the same'}"
        if figures:
            yield from figure_lines(figures)
    if every:
        file = repeat.folder / "comparison.csv"
        text = io.StringIO()
        lines = csv.writer(text, lineterminator="\n")
        lines.writerow(["table", "figure", "row", "now_over_then", "then", "now"])
        lines.writerows(
            [one.table, one.column, one.key, f"{one.ratio:.6g}", one.then, one.now] for one in every
        )
        write_whole(file, text.getvalue())
        yield f"All figures: {file}"
