"""The errors that a work-precision chart may stand over, and what a reader must know of each."""

import os
from dataclasses import dataclass, replace
from functools import cached_property

import measurements
from style import number

# Runs whose energy is this many times farther from the reference's modes than chance puts it are
# another motion and not on the front.
MOST_OF_CHANCE = 10


@dataclass(frozen=True)
class Quantity:
    """One kind of error: its column in points.csv and its words; the title goes on with T."""

    column: str
    title: str
    axis: str
    subtitle: str


POSITION = Quantity(
    "error_position",
    "its error at",
    "relative position error",
    "position error at t = T: max over nodes, divided by the largest displacement",
)
ENERGY = Quantity(
    "error_energy_max",
    "its energy error up to",
    "relative energy error",
    "energy error on the way: the largest |E(t) − E(0)| at about a hundred times, divided by the"
    " largest kinetic energy",
)
MOMENTUM = Quantity(
    "error_momentum_max",
    "its momentum error up to",
    "relative momentum error",
    "momentum error on the way: largest change of the conserved linear and angular momentum",
)
MODES = Quantity(
    "error_modal_shares",
    "its modal shares' error up to",
    "total variation distance",
    "kinetic energy over the natural modes, mean over t > T/2: distance of the distribution to the"
    " reference's, 0 to 1",
)


@dataclass(frozen=True)
class View:
    """The runs of one experiment by one of their errors; `floor` is the least error that means
    anything, with its words, and None where there is no such limit."""

    quantity: Quantity
    runs: list
    front: list
    floor: float | None = None
    floor_words: str = ""
    chaotic_below: float | None = None

    @cached_property
    def smallest(self):
        """The least error that is drawn: one below the floor is not known to be that small."""
        measured = [run.error for run in self.runs if not run.failure and run.error > 0]
        return self.floor or min(measured, default=1e-16)

    def drawn_error(self, run):
        """The error at which a run is drawn: one below the floor stands on it."""
        return max(run.error, self.smallest)


def lengths(displacements):
    """The numbers that belong to the subtitle of the position error."""
    if not displacements:
        return ""
    least, largest = displacements
    if least == largest:
        return f", {number(largest)} m"
    return f" in the node's own part, {number(least)} to {number(largest)} m"


def view(directory, quantity, reference):
    """The view of what a directory holds, or None where no run has such an error: not
    measured, or zero as the turning of what only swings in a plane."""
    path = os.path.join(directory, "points.csv")
    header = measurements.read_header(path)
    if quantity is not POSITION and quantity.column not in header:
        return None
    runs = measurements.read_runs(path, quantity.column)
    if quantity is POSITION:
        front = measurements.read_front(os.path.join(directory, "front.csv"), runs)
        words = reference.certified and f"reference certified to {number(reference.certified)}"
        quantity = replace(quantity, subtitle=quantity.subtitle + lengths(reference.displacements))
        # Where the floor counts rounding in, nothing is left to say of it.
        chaotic = reference.chaotic_below
        if chaotic and reference.certified and chaotic <= reference.certified:
            chaotic = None
        return View(quantity, runs, front, reference.certified, words, chaotic)
    if not any(run.error > 0 for run in runs):
        return None
    if quantity is MOMENTUM:
        return View(quantity, runs, [])
    if quantity is MODES and reference.modal_floor:
        words = f"difference by chance {number(reference.modal_floor)}"
        return View(quantity, runs, [], reference.modal_floor, words)
    if quantity is ENERGY and reference.modal_floor and MODES.column in header:
        modes = measurements.read_runs(path, MODES.column)
        limit = MOST_OF_CHANCE * reference.modal_floor
        runs = [replace(run, counts=not other.error > limit) for run, other in zip(runs, modes)]
    return View(quantity, runs, measurements.fastest_at_each_accuracy(runs))
