"""What a method's page says: from the registry (docs/data/methods), its source file, and the studies."""

import functools
from dataclasses import dataclass

import page_data


@dataclass(frozen=True)
class Method:
    """An entry of the registry, as simulate --list-methods --csv prints it."""

    name: str
    entry: dict


@functools.cache
def all_methods():
    """All methods, in the registry's order."""
    return [Method(row["name"], row) for row in page_data.rows("methods", "methods.csv")]
