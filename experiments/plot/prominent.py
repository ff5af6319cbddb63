"""Chooses the methods of a work-precision study that stand out: a reader would choose among
them."""

from style import assign_looks

MOST = 12


def best(view, runs):
    """The method that is the fastest of these runs of a view at most of the accuracies 1e-1, ...
    1e-9; where none reaches the first, the one of the smallest error; None where no run is a
    point."""
    methods = {run.method for run in runs}
    ranked = ([run.method for run in runs_there] for runs_there in view.ranked.values())
    reaching = ([name for name in names if name in methods] for names in ranked)
    fastest = [names[0] for names in reaching if names]
    if fastest:
        return max(fastest, key=fastest.count)
    good = [run for run in runs if not run.failure]
    return min(good, key=lambda run: run.counts_at).method if good else None


def kinds(runs):
    """The runs in groups that are worth telling apart, the most important first: the families, the
    stock variants, then in each family methods with and without linear solves."""
    solving = {run.method for run in runs if run.solves > 0}
    own = [run for run in runs if not run.stock_of]
    groups = {}
    for run in own:
        groups.setdefault((0, run.family), []).append(run)
    groups[1, "stock"] = [run for run in runs if run.stock_of]
    for run in own:
        groups.setdefault((2, run.family, run.method in solving), []).append(run)
    return [groups[key] for key in sorted(groups, key=lambda key: key[0])]


def strong_methods(view):
    """The names of the methods that stand out in a record.View, at most MOST. First are those of
    its front, from the coarsest accuracy on, then the best of each kind without one. Where no more
    than MOST methods have a point at all, these are all of them."""
    runs = view.runs
    strong = list(dict.fromkeys(point.method for point in view.front))
    for kind in kinds(runs):
        method = best(view, kind)
        if method and not any(run.method in strong for run in kind):
            strong.append(method)
    drawn = list(dict.fromkeys(run.method for run in runs if not run.failure))
    if len(drawn) <= MOST:
        strong += [method for method in drawn if method not in strong]
    return strong[:MOST]


def looks_by_prominence(known, strong):
    """The looks of the methods {name: (family, stock_of)}. Methods that stand out get the first
    colours; a stock variant has the colour of its method, which then counts too."""
    owners = {known[method][1] for method in known if method in strong}
    first = [method for method in known if method in strong or method in owners]
    return assign_looks({method: known[method] for method in dict.fromkeys([*first, *known])})
