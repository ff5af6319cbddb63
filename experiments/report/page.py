"""One HTML file out of the page's template, its styles and scripts, and the data."""

import json
import re
from pathlib import Path

from measurements import BadInput
from static_part import visible

HOME = Path(__file__).resolve().parent
TEMPLATE = "page/page.html"
ORDER = "page/order.txt"
MARK = re.compile(r"<!-- qddot:(style|scripts|data|static) -->|\{\{(title)\}\}")


def read_source(name):
    """A file of this folder. Raises BadInput where it cannot be read."""
    path = HOME / name
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise BadInput(f"{path} cannot be read: {reason}.") from error


def listed(ending):
    """The files that the order lists and that end so."""
    lines = (line.strip() for line in read_source(ORDER).splitlines())
    return [line for line in lines if line.endswith(ending) and not line.startswith("#")]


def inlined(name):
    """A script's or a style's text. Raises ValueError where it would end the element that it
    stands in, or open a comment there."""
    text = read_source(name)
    found = re.search(r"</(script|style)|<!--", text, re.IGNORECASE)
    if found:
        raise ValueError(f"{name} holds {found[0]}, which cannot stand in a page.")
    return text


def json_text(content):
    """The content as JSON in ASCII that is harmless in HTML. Raises ValueError where a number is
    not finite."""
    text = json.dumps(content, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")


def element(tag, text, attributes=""):
    """An element with this text in it."""
    return f"<{tag}{attributes}>{text}</{tag}>\n"


def data_elements(content, blobs):
    """The page's data: JSON, and each blob by its name."""
    parts = [element("script", json_text(content), ' type="application/json" id="report"')]
    for name, text in blobs.items():
        parts.append(element("script", text, f' type="text/plain" id="{name}"'))
    return "".join(parts)


def html(title, content, blobs, static):
    """The whole page; `static`: what stands in <noscript>. Raises BadInput where a part of the page
    cannot be read."""
    styles = "".join(element("style", inlined(name)) for name in listed(".css"))
    scripts = "".join(element("script", inlined(name)) for name in listed(".js"))
    parts = {
        "style": styles,
        "scripts": scripts,
        "data": data_elements(content, blobs),
        "static": static,
        "title": visible(title),
    }
    # All at once, so that no part's own text is taken for a mark.
    return MARK.sub(lambda mark: parts[mark[1] or mark[2]], read_source(TEMPLATE))
