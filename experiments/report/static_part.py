"""What a page shows where no scripts run: the chart's picture and the answers as plain HTML."""

from html import escape

from answers import runs_of_answers
from style import number, seconds

COLUMNS = (
    "accuracy",
    "fastest method",
    "knob",
    "error",
    "time",
    "next best method",
    "to know",
)


def visible(text):
    """A text as HTML in one line; what is not printed, as the marks that turn its direction, is a
    space."""
    return escape("".join(c if c.isprintable() else " " for c in str(text)))


def how_long(ratio):
    """How many times as long a run takes, in words."""
    times = f"{ratio:.3g}"
    return "just as long" if times == "1" else f"{times} × as long"


def cells(group, runs):
    """The cells of the row of one or more answers that name the same run; the next method is that of
    the coarsest."""
    answer = group[0]
    ends = dict.fromkeys(number(group[place]["accuracy"]) for place in (0, -1))
    accuracy = " to ".join(ends)
    if answer["point"] is None:
        return (accuracy, answer["why"], "", "", "", "", "")
    run = runs[answer["point"]]
    following = ""
    if answer["next"]:
        other = runs[answer["next"]["point"]].method
        following = f"{other}, {how_long(answer['next']['ratio'])}"
    figures = (number(run.error), seconds(run.time))
    return (accuracy, run.method, run.knob_words, *figures, following, answer["warning"] or "")


def row(tag, texts):
    """A row of a table."""
    return "<tr>" + "".join(f"<{tag}>{visible(text)}</{tag}>" for text in texts) + "</tr>"


def static_part(content, runs, chart):
    """HTML for a page's <noscript>: the notes and the answers of its content, by these runs, and the
    chart's data URI, if there is one."""
    lines = [f"<p>{visible(note)}</p>" for note in content["notes"]]
    lines += ["<table>", f"<thead>{row('th', COLUMNS)}</thead>", "<tbody>"]
    lines += [row("td", cells(group, runs)) for group in runs_of_answers(content["answers"])]
    lines += ["</tbody>", "</table>"]
    if content["answers_note"]:
        lines.append(f"<p>{visible(content['answers_note'])}</p>")
    if chart:
        words = "time of a run against its error, by method"
        lines.append(f'<img src="{chart}" alt="{words}" style="max-width:100%">')
    return "\n".join(lines)
