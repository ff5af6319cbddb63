"""Names of scenes, which may hold anything, as a picture can show them."""

LONGEST = 60


def shown(name):
    """The name in one line, cut where it is long; a dollar sign begins no formula."""
    line = "".join(c if c.isprintable() else " " for c in str(name))
    if len(line) > LONGEST:
        line = line[: LONGEST - 1] + "…"
    return line.replace("$", r"\$")
