"""What a page shows where no scripts run: the chart's picture and the answers as plain HTML."""

from html import escape

from answers import knob_in_words
from style import number, seconds

COLUMNS = ("accuracy", "fastest method", "knob", "error", "time", "next best method")


def visible(text):
    """A text as HTML in one line; what is not printed, as the marks that turn its direction, is a
    space."""
    return escape("".join(c if c.isprintable() else " " for c in str(text)))


def cells(answer, runs):
    """The cells of an answer's row."""
    accuracy = f"{answer['accuracy']:.0e}"
    if answer["point"] is None:
        return (accuracy, answer["why"], "", "", "", "")
    run = runs[answer["point"]]
    following = ""
    if answer["next"]:
        other = runs[answer["next"]["point"]].method
        following = f"{other}, {answer['next']['ratio']:.3g} × as long"
    knob = knob_in_words(run.knob, run.value)
    return (accuracy, run.method, knob, number(run.error), seconds(run.time), following)


def row(tag, texts):
    """A row of a table."""
    return "<tr>" + "".join(f"<{tag}>{visible(text)}</{tag}>" for text in texts) + "</tr>"


def static_part(answers, runs, notes, chart):
    """HTML for a page's <noscript>: the notes, the answers of these runs and the chart's data URI,
    if there is one."""
    lines = [f"<p>{visible(note)}</p>" for note in notes]
    lines += ["<table>", f"<thead>{row('th', COLUMNS)}</thead>", "<tbody>"]
    lines += [row("td", cells(answer, runs)) for answer in answers]
    lines += ["</tbody>", "</table>"]
    if chart:
        lines.append(f'<img src="{chart}" alt="time of a run against its error, by method">')
    return "\n".join(lines)
