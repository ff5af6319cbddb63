"""The page of a motion by several methods: that of a report, without a chart."""

import os
import shlex
from dataclasses import dataclass

import numpy as np

from background_part import left_out_part, provenance_part
from methods_part import method_entries
from motion_files import MotionFile
from motion_part import pack
from names import one_line
from page import html
from pictures_part import data_uri
from points_part import COUNTS, NUMBERS
from report import MOST_BYTES, WORDS_ON_MOTIONS
from runs import ACCURACY, method_looks
from static_part import static_part

ERROR = "error_position"


@dataclass
class ComparedFile(MotionFile):
    """A motion with each node's distance [m] from another one, at the latter's frame nearest in
    time."""

    exact: MotionFile | None = None

    def distances(self, frames):
        """The distances (frames, nodes) [m]; None where there is nothing to compare with."""
        if self.exact is None:
            return None
        frames = list(frames)
        nearest = np.abs(self.exact.times - self.times[frames][:, None]).argmin(axis=1)
        apart = self.positions(frames) - self.exact.positions(nearest)
        return np.linalg.norm(apart, axis=-1)


@dataclass(frozen=True)
class PackedRuns:
    """What a packer of motions asks of a study."""

    runs: list
    sidecar: dict
    reference: dict


@dataclass(frozen=True)
class Point:
    """A run among the points of the page."""

    method: str
    knob: str
    value: float
    knob_words: str


def largest_displacement(run):
    """How far [m] a node comes from its start; None where nothing moves."""
    apart = np.linalg.norm(run.positions - run.positions[0], axis=-1)
    return float(apart.max()) or None


def error_of(run, exact, unit):
    """The relative position error at the end; None where that is not known."""
    if exact is None or unit is None or run.failed:
        return None
    apart = np.linalg.norm(run.positions[-1] - exact.positions[-1], axis=-1)
    return float(f"{apart.max() / unit:.4g}")


def points_of(drawn, runs, errors):
    """The page's `points`."""
    points = dict.fromkeys((*NUMBERS, *COUNTS), [None] * len(runs))
    points |= {
        "method": list(range(len(runs))),
        "value": [run.value for run in runs],
        "knob": ["step_size"] * len(runs),
        "knob_words": [f"h = {run.value:.4g} s" for run in runs],
        "outcome": [run.sidecar["outcome"] for run in runs],
        "cause": [run.why or None for run in runs],
        "t_reached": [run.sidecar["t_reached"] for run in runs],
        "energy_growth": [finite(run.sidecar.get("energy_growth")) for run in runs],
        ERROR: errors,
    }
    words = ["build/bin/simulate", "--scene", drawn.argument, "--until", repr(drawn.until)]
    points["command"] = [
        shlex.join([*words, "--method", run.method, "--step-size", repr(run.value)]) for run in runs
    ]
    return points


def finite(value):
    """The number; None where it is none."""
    return value if isinstance(value, float) and np.isfinite(value) else None


def quantity(runs, errors):
    """The only kind of error of the page."""
    return {
        "column": ERROR,
        "name": "positions at the end",
        "axis": "relative position error",
        "subtitle": None,
        "floor": None,
        "floor_words": None,
        "counts": None,
        "lucky": {},
        "failures": [
            run.why or (None if error is not None else "its error is not known")
            for run, error in zip(runs, errors)
        ],
    }


def motion_of(drawn, exact, runs, points, unit, room):
    """The page's `motion`, its blobs and notes in at most `room` bytes."""
    sidecar = {"scene": {"dimension": drawn.dimension, "gravity": drawn.gravity}}
    study = PackedRuns(points, sidecar, {})
    opened, energies = [], {}
    for run in [*([exact] if exact else []), *runs]:
        is_exact = run is exact
        row = {
            "file": run.motion.name,
            "role": "reference" if is_exact else "run",
            "method": run.method if is_exact else run.name,
            "knob": "step_size",
            "outcome": run.sidecar["outcome"],
            "why": f"error at most {ACCURACY}" if is_exact else "",
            "value": run.value,
            "t_reached": run.sidecar["t_reached"],
            "seconds": None,
        }
        motion = run.motion
        if not is_exact:
            motion = ComparedFile(**vars(motion), exact=exact.motion if exact else None)
        opened.append((row, motion))
        energies[run.motion.name] = run.energies
    return pack(study, {"displacement": unit}, opened, energies, [], room)


def page_of(folder, drawn, step_size, exact, runs):
    """The page as text; its picture lies in the folder."""
    unit = largest_displacement(exact) if exact else None
    errors = [error_of(run, exact, unit) for run in runs]
    parts = points_of(drawn, runs, errors)
    points = [
        Point(run.method, "step_size", run.value, words)
        for run, words in zip(runs, parts["knob_words"])
    ]
    # The command line of a run names files that are gone.
    origin = runs[0].sidecar | {"command_line": []}
    looks = method_looks([run.method for run in runs])
    known = {name: (family, "") for name, (_, family, _) in looks.items()}
    lines = {name: line for name, (_, _, line) in looks.items()}
    methods = ",".join(run.method for run in runs)
    command = ["./run", "motion", drawn.argument, "--methods", methods, "--step-size", step_size]
    picture = data_uri(os.path.join(folder, "motion.png"))
    notes = [] if exact else ["No exact motion was found to compare with."]
    content = {
        "title": one_line(drawn.name),
        "until": drawn.until,
        "command": [shlex.join([*command, "--until", repr(drawn.until)])],
        "notes": notes,
        "answers": None,
        "answers_note": None,
        "judged_by": "position",
        **method_entries(known, list(known), lines),
        "points": parts,
        "counts": [],
        "quantities": [quantity(runs, errors)],
        "left_out": left_out_part(origin),
        "reference": [],
        "provenance": provenance_part(origin),
        "pictures": [{"title": "All in one picture", "alt": "motion and energy", "src": picture}],
    }

    def page(motion, blobs, more):
        """The page with this motion."""
        whole = content | {"notes": notes + more, "motion": motion}
        return html(content["title"], whole, blobs, static_part(whole | {"answers": []}, [], picture))

    room = MOST_BYTES - WORDS_ON_MOTIONS - len(page(None, {}, []).encode("utf-8", "replace"))
    return page(*motion_of(drawn, exact, runs, points, unit, room))
