"""Names of arguments: a misspelt one is refused with the nearest that there is."""

from __future__ import annotations

import difflib
import functools
import inspect
from typing import Any, Callable, Iterable, TypeVar, cast

F = TypeVar("F", bound=Callable[..., Any])

# The words of other packages for the arguments here.
_ELSEWHERE = {
    "step_size": "dt h step stepsize timestep time_step tau max_step",
    "until": "t_end tend t_max tmax t_final t_span T end end_time t_bound",
    "save_at": "t_eval saveat times dense_output",
    "rtol": "tol reltol rel_tol tolerance",
    "atol": "abstol abs_tol",
    "q0": "y0 x0 u0",
    "v0": "w0 qdot0",
    "seconds": "time_limit timeout",
    "stiffness": "K k jac jacobian hessian",
    "force": "f fun rhs",
    "potential": "V energy",
    "mass": "M m masses",
    "positions": "X x nodes points vertices",
    "springs": "edges links bonds elements",
    "rest_length": "l0 length lengths rest_lengths",
    "pinned": "fixed pins",
    "gravity": "g",
    "accuracies": "accuracy",
    "accuracy": "accuracies",
}


def nearest(name: str, names: Iterable[str]) -> str:
    """The one of the names that is nearest to another one, as it is spelt or as it is called
    elsewhere; empty if there is none."""
    allowed = list(names)
    for ours, others in _ELSEWHERE.items():
        if ours in allowed and name in others.split():
            return ours
    close = difflib.get_close_matches(name.lower(), allowed, 1)
    return close[0] if close else ""


def hint(name: str, names: Iterable[str]) -> str:
    """The end of a sentence that names the nearest; empty if there is none."""
    found = nearest(name, names)
    return f", the nearest is {found}" if found else ""


def knows_its_arguments(function: F) -> F:
    """The same function, or __init__ of a class. It raises a TypeError with the nearest name for an
    argument that it does not have, and for one without a name that needs it."""
    label = function.__qualname__.replace(".__init__", "")
    parameters = inspect.signature(function).parameters
    names = [name for name in parameters if name not in ("self", "cls")]
    most = sum(p.kind is p.POSITIONAL_OR_KEYWORD for p in parameters.values())
    first_named = names[most - (len(parameters) - len(names)) :]

    @functools.wraps(function)
    def checked(*arguments: Any, **named: Any) -> Any:
        if len(arguments) > most and first_named:
            raise TypeError(
                f"{label}: {arguments[most]!r} has no name; the arguments that need one are "
                f"{', '.join(first_named)}"
            )
        for name in named:
            if name not in names:
                raise TypeError(
                    f"{name} is no argument of {label}{hint(name, names)}; there are "
                    f"{', '.join(names)}"
                )
        return function(*arguments, **named)

    return cast(F, checked)
