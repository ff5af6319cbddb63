"""What whole runs of the program stability_map say of a method: up to which step size all of them
held, and what became of those with longer steps.

The run of the least step that failed is no limit: the next longer steps can hold again. So a page
says up to where all runs held, and beside it how many of the longer ones failed.
"""

from dataclasses import dataclass

from page_data import NOTHING, BadPage, figures, rows

HELD = ("bounded", "leaked", "over_budget")
GROWN = ("gained", "diverged")


@dataclass(frozen=True)
class Endurance:
    """What became of runs of one method. Each h ω is a measured one; None where there is none."""

    held_to: float  # the largest h ω up to which every run held
    failed_from: float  # the next one, at which a run failed
    longest: float  # the largest h ω
    longer: int  # how many runs have steps as long as failed_from or longer
    failed: int  # how many of these failed
    grown: int  # how many of these gained energy or diverged
    least_growth: float  # of these, the least ratio of the largest energy to that at the start


def has_grown(run):
    """Whether its energy was larger by half at the end, or grew without bound."""
    return run["outcome"] in GROWN


def endurance(runs):
    """What became of these rows of map.csv."""
    if not runs:
        raise BadPage("there are no runs of that method and amplitude")

    def h_omega(run):
        return float(run["h_omega"])

    failed_from = min((h_omega(run) for run in runs if run["outcome"] not in HELD), default=None)
    below = [h_omega(run) for run in runs if failed_from is None or h_omega(run) < failed_from]
    longer = [run for run in runs if failed_from is not None and h_omega(run) >= failed_from]
    grown = [run for run in longer if has_grown(run)]
    return Endurance(
        held_to=max(below, default=None),
        failed_from=failed_from,
        longest=max(map(h_omega, runs)),
        longer=len(longer),
        failed=sum(run["outcome"] not in HELD for run in longer),
        grown=len(grown),
        least_growth=min((float(run["energy_max"]) for run in grown), default=None),
    )


def endurance_of(study, method, **where):
    """What became of a method's runs in a study of stability_map, those with these values alone."""
    return endurance(rows(study, "map.csv", method=method, **where))


def endurance_words(found):
    """A cell of a table: the largest h ω up to which all runs held; how many longer ones failed."""
    if found.failed_from is None:
        return f"{figures(found.longest)}; none"
    held = NOTHING if found.held_to is None else figures(found.held_to)
    return f"{held}; {found.failed} of {found.longer}"
