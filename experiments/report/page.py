"""One HTML file out of the page's template, its styles and scripts, and the data."""

import json
import re
from pathlib import Path

from static_part import visible

HOME = Path(__file__).resolve().parent
TEMPLATE = "page/page.html"
STYLES = tuple(f"page/css/{name}.css" for name in ("page", "answers", "chart", "run", "print"))
# The answers come before the libraries, so that they are on the screen while the browser reads
# these. A module brings those that it imports.
SCRIPTS = (
    "page/js/answers.js",
    "vendor/plotly-basic.min.js",
    "vendor/three.min.js",
    "page/js/page.js",
)
IMPORT = re.compile(r'^import (?:\{([^}]*)\} from )?"\./([^"]+)";\n', re.MULTILINE)
EXPORT = re.compile(r"^export ((?:const|function|async function) (\w+))", re.MULTILINE)
MARK = re.compile(r"<!-- qddot:(style|scripts|data|static) -->|\{\{(title)\}\}")


def read_source(name):
    """A file of this folder."""
    return (HOME / name).read_text(encoding="utf-8")


def inlined(name):
    """A script's or a style's text. Raises ValueError where it would end the element that it
    stands in, or open a comment there."""
    text = read_source(name)
    found = re.search(r"</(script|style)|<!--", text, re.IGNORECASE)
    if found:
        raise ValueError(f"{name} holds {found[0]}, which cannot stand in a page.")
    return text


def with_imports(name, known):
    """A script after all that it imports, but for those already known, to which they are added."""
    if name in known:
        return []
    known.add(name)
    folder = name.rpartition("/")[0]
    imported = [f"{folder}/{file}" for _, file in IMPORT.findall(read_source(name))]
    return [script for file in imported for script in with_imports(file, known)] + [name]


def packed_script(name):
    """A library as it is, or a module in a block of its own. What a module exports is a part of the
    page's one object, qddotReport, from which modules import."""
    text = inlined(name)
    if name.startswith("vendor/"):
        return text
    exports = ", ".join(found[1] for found in EXPORT.findall(text))
    own = EXPORT.sub(r"\1", IMPORT.sub(r"const {\1} = qddotReport;\n", text))
    return f'"use strict";\n{{\n{own}Object.assign(qddotReport, {{{exports}}});\n}}\n'


def scripts():
    """The texts of the page's scripts in their order."""
    known = set()
    names = [name for script in SCRIPTS for name in with_imports(script, known)]
    return ["const qddotReport = {};\n", *map(packed_script, names)]


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
    """The whole page; `static`: what stands in <noscript>."""
    parts = {
        "style": "".join(element("style", inlined(name)) for name in STYLES),
        "scripts": "".join(element("script", text) for text in scripts()),
        "data": data_elements(content, blobs),
        "static": static,
        "title": visible(title),
    }
    # All at once, so that no part's own text is taken for a mark.
    return MARK.sub(lambda mark: parts[mark[1] or mark[2]], read_source(TEMPLATE))
