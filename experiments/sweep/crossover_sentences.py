"""Says in sentences where, along a parameter of a scene, the fastest method changes."""

import re

from fastest_table import accuracy_in_words
from names import shown
from style import exact, number, seconds

MOST = 8


def value_in_words(along, value):
    """A value of what is varied, with its unit where that is known."""
    if along == "until" and value > 0:
        return seconds(value)
    if abs(value) >= 1e5:
        return number(value)
    return f"{value:,.0f}" if value == round(value) else exact(value)


def common_beginning(low, high, along):
    """What the names of two scenes begin with, in whole words and but for what is varied: "chain"
    of chain_nodes_300 and chain_nodes_1000."""
    words = []
    for left, right in zip(re.split(r"[_\s=,-]+", low), re.split(r"[_\s=,-]+", high)):
        if left != right:
            break
        words.append(left)
    beginning = "_".join(words)
    if beginning != along:
        beginning = beginning.removesuffix(f"_{along}")
    return beginning or f"{low} to {high}"


def change_in_words(crossover):
    """The change of one row, but for the accuracy."""
    first, then = map(shown, crossover.methods)
    scenes = shown(common_beginning(*crossover.scenes, crossover.along))
    along = crossover.along
    if crossover.crossing is None:
        low, high = (value_in_words(along, value) for value in (crossover.low, crossover.high))
        change = f"{first} up to {low}, {then} from {high} on"
    else:
        crossing = value_in_words(along, float(f"{crossover.crossing:.2g}"))
        change = f"{first} up to some {crossing}, then {then}"
    return f"{scenes}, {shown(along)}: {change}"


def listed(words):
    """Words with commas and an "and" between them."""
    return " and ".join([*([", ".join(words[:-1])] if words[1:] else []), *words[-1:]])


def sentences(crossovers):
    """A sentence for each change, in the order of the file, at most MOST of them; then one that
    says how many rows have none. Rows that differ by their accuracy alone share one."""
    changes = {}
    for crossover in crossovers:
        changes.setdefault(change_in_words(crossover), []).append(crossover.accuracy)
    said = [
        f"{change}, at {listed([accuracy_in_words(value) for value in accuracies])}"
        for change, accuracies in list(changes.items())[:MOST]
    ]
    rest = sum(len(accuracies) for accuracies in list(changes.values())[MOST:])
    return [*said, *([f"and {rest} more in crossovers.csv"] if rest else [])]
