"""The methods of a study as the page shows them: colours, marks, families and the line on each."""

from prominent import looks_by_prominence, strong_methods
from style import STOCK
from study_folder import look


def family_entry(name, family):
    """One entry of the page's `families`; `dash`: dashes and gaps in pixels, none for a solid line."""
    lengths = () if isinstance(family.line, str) else family.line[1]
    return {
        "name": name,
        "title": family.title,
        "dash": [family.width * length for length in lengths],
        "filled": family.filled,
        "width": family.width,
    }


def methods_part(study):
    """The page's `families` and `methods`, the latter in the order of the points."""
    known = {run.method: (run.family, run.stock_of) for run in study.runs}
    strong = strong_methods(study.record.judged)
    looks = looks_by_prominence(known, strong)
    notes = study.method_notes
    orders = {row["method"]: row.get("order") for _, row in study.rows}
    families, methods = {}, []
    for method, (family, stock_of) in known.items():
        drawn = looks[method].family
        name = "stock" if drawn is STOCK else family
        families.setdefault(name, family_entry(name, drawn))
        order = orders[method] or ""
        methods.append(
            {
                "name": method,
                "family": list(families).index(name),
                "order": int(order) if order.isdecimal() and int(order) else None,
                "color": looks[method].color,
                "text_color": looks[method].text_color,
                "marker": looks[method].marker,
                "stock_of": stock_of or None,
                "strong": method in strong,
                "line": look(notes.get(method), "summary"),
            }
        )
    return {"families": list(families.values()), "methods": methods}
