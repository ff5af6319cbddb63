"""Cells of the tables of all methods."""

SHOWN = {"framed_cloth": "framed cloth", "stiff_frame": "stiff frame"}


def link(name):
    """A method's name, with a link to its page."""
    return f"[`{name}`](methods/{name}.md)"


def limit_of(method):
    """The largest stable h ω by theory, as a table says it."""
    if not method.is_fixed:
        return "chosen"
    if not method.order:
        return "unlimited"
    if not method.limit:
        return "–"
    limit = method.limit["h_omega_limit_predicted"]
    if not limit:
        return "unlimited"
    return "none" if float(limit) == 0 else f"{float(limit):.6g}"


def at(method, which):
    """The scenes and accuracies at which it is the fastest, or near."""
    places = [place for place in method.places if getattr(place, which)]
    words = [f"{SHOWN.get(place.chart, place.chart)} {place.words(which)}" for place in places]
    return "; ".join(words) or ("–" if method.places or method.lacks_scenes else "not measured yet")
