"""How Sphinx makes the site of these pages (see developing.md for the commands)."""

import os
import re
from pathlib import Path

from docutils import nodes
from sphinx import addnodes
from sphinx.util.osutil import relative_uri

ROOT = Path(__file__).resolve().parents[1]

project = "qddot"
author = "The qddot authors"
project_copyright = "The qddot authors, BSD-3-Clause"
version = release = re.search(
    r"project\(qddot VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
)[1]

extensions = ["myst_parser", "breathe"]
root_doc = "index"
# Templates and what they are rendered from.
exclude_patterns = ["pages", "site", "data", "scenes"]

myst_heading_anchors = 3

# Doxygen's reading of the headers (docs/Doxyfile).
breathe_projects = {"qddot": str(ROOT / "results/docs/doxygen/xml")}
breathe_default_project = "qddot"
breathe_default_members = ("members", "undoc-members")
primary_domain = "cpp"
highlight_language = "text"

# Names in C++ signatures that are other libraries', are namespaces, or are the reduction's own.
nitpick_ignore_regex = [
    ("cpp:identifier", r"(std|Eigen)(::.*)?"),
    ("cpp:identifier", r"qddot(::measure)?"),
    ("cpp:identifier", r"Chart"),  # the record that pictures are drawn from
    ("cpp:identifier", r"reduce(::Part)?"),
    # Classes that methods are made from, for authors of methods.
    ("cpp:identifier", r"Splitting|NystromPair|SymmetricFormula|Stepper|SystemRun"),
    ("cpp:identifier", r"Mass|BesideForce"),  # Mass is a Vec to users; kernels have the other
    ("cpp:identifier", r"Vector(::.*)?"),  # Eigen's, by a name of its own
]

html_theme = "furo"
pygments_style = "default"
pygments_dark_style = "monokai"
html_title = f"qddot {version}"
html_static_path = ["site/static"]
html_css_files = ["narrow.css"]
html_show_sourcelink = False
html_copy_source = False


def file_named(env, docname, target):
    """The file of the project that a link names; None where there is none or it is a page."""
    path = (Path(env.doc2path(docname)).parent / target.partition("#")[0]).resolve()
    if target.startswith("#") or not path.is_relative_to(ROOT) or not path.exists():
        return None
    return None if env.path2doc(str(path)) in env.found_docs else path


def link_files(app, doctree):
    """Makes links to files that are no pages, as ../src/qddot/model/system.hpp, lead there: below the
    config value `source_url`, or where that is empty in the tree that the site lies in. A link to
    what does not exist is left to MyST, which warns of it."""
    docname = app.env.docname
    for kind in (addnodes.download_reference, addnodes.pending_xref):
        for link in list(doctree.findall(kind)):
            path = file_named(app.env, docname, link["reftarget"])
            if link.get("reftype") != "myst" or path is None:
                continue
            if app.config.source_url:
                place = app.config.source_url + path.relative_to(ROOT).as_posix()
            else:
                page = Path(app.outdir, docname)
                place = Path(os.path.relpath(path, page.parent)).as_posix()
            # The node that held the text of a cross-reference has its looks, too.
            text = link[0].children if link.children and link[0].children else link.children
            link.replace_self(nodes.reference("", "", *text, refuri=place))


def open_pictures(app, doctree, docname):
    """Makes the links around pictures lead to the site's own copies of them."""
    for picture in doctree.findall(nodes.image):
        if isinstance(picture.parent, nodes.reference):
            _, name = app.env.images[picture["uri"]]
            target = f"{app.builder.imagedir}/{name}"
            picture.parent["refuri"] = relative_uri(app.builder.get_target_uri(docname), target)


def name_left_out(app, env, link, text):
    """Shows the name of a derived class that cpp_reference.md does not have, without a link."""
    if link["reftype"] == "ref" and link["reftarget"].startswith("classqddot_"):
        return text
    return None


def setup(app):
    """Called by Sphinx."""
    app.add_config_value("source_url", "", "env")
    app.connect("doctree-read", link_files, priority=100)  # before files are copied as downloads
    app.connect("doctree-resolved", open_pictures)
    app.connect("missing-reference", name_left_out)
