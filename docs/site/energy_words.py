"""What became of the energy in a run of energy_drift, in few words, from its row of summary.csv."""

from page_data import figures, small

WORDS = {
    "bounded": lambda run: f"bounded, ± {small(run['oscillation'])}",
    "round_off": lambda run: "round-off",
    "undecided": lambda run: f"undecided, ± {small(run['oscillation'])}",
    "widens": lambda run: f"widens at {small(run['widening'])}/s",
    "drifts": lambda run: f"drifts, {small(run['drift_rate'])}/s",
    "dissipates": lambda run: f"damped, ζ = {small(run['damping_ratio'])}",
    "grows": lambda run: f"grows, {small(run['exponential_rate'])}/s",
    "blows_up": lambda run: f"blows up at {figures(run['blow_up_time'])} s",
}


def energy_in_words(run):
    """The verdict with its number; of a run that its time limit ended early what it was so far; and
    what the energy changed by before the part that the verdict is of."""
    if run["fate"] == "unknown":
        so_far = WORDS.get(run["fate_so_far"])
        known = f": {so_far(run)} so far" if so_far else ""
        return f"too short to tell{known}, {figures(run['t_reached'])} s run"
    before = f"{figures(run['energy_error_end'])}, then " if run["has_settled"] == "yes" else ""
    return before + WORDS[run["fate"]](run)
