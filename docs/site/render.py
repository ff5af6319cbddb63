"""Writes README.md, CITATION.cff and the pages of docs/ from their templates in docs/pages/, with the measured
numbers put in.

    render.py               writes them
    render.py --check       says which are not as their templates and docs/data have them; status 1
    render.py --draft NAME  prints one; what is not measured yet is shown as such

A template is Markdown with {{ ... }} and {% ... %} of Jinja. It can call what page_data.py and
chart_data.py offer, and what a Python file of its own name beside it defines.
"""

import inspect
import re
import runpy
import sys

import jinja2

import chart_data
import energy_words
import method_pages
import page_data
import whole_runs
from page_data import ROOT

PAGES = ROOT / "docs/pages"
# The functions that a template can call.
CALLS = {
    name: call
    for module in (page_data, chart_data, energy_words, whole_runs)
    for name, call in vars(module).items()
    if inspect.isroutine(call) or hasattr(call, "cache_clear")
}
NOTICE = "<!-- Made by ./run docs from {source}. Change that file, not this one. -->\n\n"


def environment(calls=CALLS):
    """Jinja with what pages may call, also as filters; an unknown name is an error."""
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(PAGES),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.globals.update(calls, methods=method_pages.all_methods)
    made.filters.update(calls)
    return made


def own_calls(template):
    """What the Python file beside a template defines, by name."""
    file = (PAGES / template).with_suffix(".py")
    defined = runpy.run_path(str(file)) if file.exists() else {}
    return {name: value for name, value in defined.items() if not name.startswith("_")}


def rendered():
    """All pages by their files: those of the templates, README.md in the root, and one a method."""
    jinja = environment()
    wanted = [(file.name, file.name, own_calls(file.name)) for file in sorted(PAGES.glob("*.md"))]
    wanted = [page for page in wanted if page[0] != "method.md"]
    for method in method_pages.all_methods():
        wanted.append((f"methods/{method.name}.md", "method.md", {"method": method}))
    pages = {}
    for name, template, values in wanted:
        page_data.said_on_page.clear()
        notice = NOTICE.format(source=f"docs/pages/{template}")
        file = ROOT / ("" if name == "README.md" else "docs") / name
        page = without_unsaid(jinja.get_template(template).render(**values))
        pages[file] = notice + with_opened_pictures(page)
    citation = jinja.get_template("CITATION.cff").render()
    pages[ROOT / "CITATION.cff"] = citation
    return pages


def without_unsaid(page):
    """A page without the places where `made` had nothing to say, and the spaces or lines before."""
    page = re.sub(rf"^{page_data.UNSAID}\n+", "", page, flags=re.MULTILINE)
    return re.sub(rf"\s?{page_data.UNSAID}", "", page)


def with_opened_pictures(page):
    """A page whose pictures are links to their full size, for screens that show them smaller."""
    return re.sub(r"^(!\[[^\]]*\]\(([^)\s]+)\))$", r"[\1](\2)", page, flags=re.MULTILINE)


class NotMeasured(jinja2.ChainableUndefined):
    """Stands in a draft for what is not measured, whatever is asked of it."""

    def __call__(self, *_, **__):
        return self

    __truediv__ = __rtruediv__ = __mul__ = __rmul__ = __call__

    def __float__(self):
        return float("nan")

    def __str__(self):
        return "(not measured)"


def drafted(call):
    """A function of pages, with what is not measured in place of an error."""

    def tried(*words, **named):
        try:
            return call(*words, **named)
        except (page_data.BadPage, KeyError) as error:
            print(f"draft: {error}", file=sys.stderr)
            return NotMeasured()

    return tried


def draft(name):
    """One page of a template; of method.md that of the method NAME."""
    jinja = environment({name: drafted(call) for name, call in CALLS.items()})
    for method in method_pages.all_methods():
        if method.name == name:
            return without_unsaid(jinja.get_template("method.md").render(method=method))
    own = {
        key: drafted(value) if callable(value) else value for key, value in own_calls(name).items()
    }
    return without_unsaid(jinja.get_template(name).render(own))


def main():
    if "--draft" in sys.argv[1:]:
        print(draft(sys.argv[-1]))
        return 0
    try:
        pages = rendered()
    except (page_data.BadPage, jinja2.TemplateError) as error:
        where = f"{error.name}, line {error.lineno}: " if hasattr(error, "lineno") else ""
        sys.exit(f"render: {where}{error}")
    there = set((ROOT / "docs/methods").glob("*.md"))
    if "--check" in sys.argv[1:]:
        old = [
            file for file, page in pages.items() if not file.exists() or file.read_text() != page
        ]
        old += sorted(there - pages.keys())
        for file in old:
            print(f"{file.relative_to(ROOT)} is not what its template says: ./run docs")
        return 1 if old else 0
    (ROOT / "docs/methods").mkdir(exist_ok=True)
    for file in there - pages.keys():
        file.unlink()
    for file, page in pages.items():
        if not file.exists() or file.read_text() != page:
            file.write_text(page, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
