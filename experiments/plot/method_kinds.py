"""The kinds of methods that a reader would choose between, and their colours."""

from style import COOL, FAINT, WARM

# Warm kinds take forces alone; cool ones treat stiff springs apart or solve linear systems.
COLORS = {
    "Euler and Verlet": WARM[2],
    "symmetric multistep": WARM[3],
    "other explicit": WARM[0],
    "multirate": COOL[1],
    "implicit": COOL[0],
    "SUNDIALS": FAINT,
}
# How the names of a kind's methods begin; the others are told by whether they solve linear systems.
BEGINNINGS = {
    "Euler and Verlet": ("explicit_euler", "symplectic_euler", "verlet", "position_verlet"),
    "symmetric multistep": ("symmetric",),
    "multirate": ("multirate",),
}


def kind_of(run):
    """The kind of the method of a run."""
    if run.family == "sundials":
        return "SUNDIALS"
    for kind, beginnings in BEGINNINGS.items():
        if run.method.startswith(beginnings):
            return kind
    return "implicit" if run.solves > 0 else "other explicit"
