"""The methods of a study as the page shows them: colours, marks, families and the line on each."""

from prominent import looks_by_prominence, strong_methods
from style import STOCK
from study_folder import look


def dash(family):
    """The dashes and gaps of a family's line in pixels; none for a solid one."""
    line = family.line
    return [] if isinstance(line, str) else [family.width * length for length in line[1]]


def family_entry(family):
    """One entry of the page's `families`."""
    return {
        "title": family.title,
        "dash": dash(family),
        "filled": family.filled,
        "width": family.width,
    }


def method_entries(known, strong, lines):
    """The page's `families` and `methods` for {name: (family, stock_of)}; `lines`: what each method
    is, by name."""
    looks = looks_by_prominence(known, strong)
    families, methods = {}, []
    for method, (family, _) in known.items():
        drawn = looks[method].family
        name = "stock" if drawn is STOCK else family
        families.setdefault(name, family_entry(drawn))
        methods.append(
            {
                "name": method,
                "family": list(families).index(name),
                "color": looks[method].color,
                "text_color": looks[method].text_color,
                "marker": looks[method].marker,
                "strong": method in strong,
                "line": lines.get(method),
            }
        )
    return {"families": list(families.values()), "methods": methods}


def methods_part(study):
    """The page's `families` and `methods`, the latter in the order of the points."""
    known = {run.method: (run.family, run.stock_of) for run in study.runs}
    lines = {name: look(note, "summary") for name, note in study.method_notes.items()}
    return method_entries(known, strong_methods(study.record.judged), lines)
