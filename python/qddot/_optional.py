"""Packages that only some functions need."""

from __future__ import annotations

import importlib.util


def require_package(name: str, what: str) -> None:
    """Raises ImportError, with the names of its packages, if that one is not installed."""
    if importlib.util.find_spec(name) is None:
        raise ImportError(
            f"{what} {name}, which is not installed; Debian's package is python3-{name}, and pip's "
            f"is {name}",
            name=name,
        )
