"""Names of scenes, which may hold anything, as a picture can show them."""

LONGEST = 60


def one_line(name):
    """The name in one line, cut where it is long."""
    line = "".join(c if c.isprintable() else " " for c in str(name))
    return line if len(line) <= LONGEST else line[: LONGEST - 1] + "…"


def shown(name):
    """The same as a text of matplotlib's, in which a dollar sign begins no formula."""
    return one_line(name).replace("$", r"\$")
