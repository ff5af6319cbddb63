"""The command lines that repeat a page and its runs, quoted for a shell."""

import shlex
from itertools import pairwise

from study_folder import look

LISTS = ("--methods", "--no-reduce", "--accuracies")
# The options of the study that every run takes, beside those of its method.
OF_EVERY_RUN = ("--no-reduce", "--threads")
# ./run report gives this one itself.
GIVEN_BY_RUN = {"--point-limit": "0.5"}


def scene_argument(sidecar):
    """What the study's command line says for --scene; None where that is not known."""
    for word, following in pairwise([*(sidecar.get("command_line") or []), None]):
        if word == "--scene":
            return following
        if word.startswith("--scene="):
            return word.removeprefix("--scene=")
    return None


def study_options(sidecar):
    """The options that decided what the study measured, {name: value}; a list is joined by commas,
    of other options the last value counts, a flag has None."""
    found = {}
    for name, values in (look(sidecar, "study", "options") or {}).items():
        if values == ["true"]:
            found[name] = None
        elif values:
            found[name] = ",".join(values) if name in LISTS else values[-1]
    return found


def words_of(options):
    """The words that give these options."""
    words = []
    for name, value in options.items():
        # A value that begins with a dash would be read as an option.
        if value is not None and value.startswith("-"):
            words.append(f"{name}={value}")
        else:
            words += [name] if value is None else [name, value]
    return words


def page_command(sidecar):
    """The line that measures all of the page again; None where the scene's argument is not
    known."""
    scene = scene_argument(sidecar)
    if scene is None:
        return None
    options = study_options(sidecar)
    own = [pair for pair in options.items() if pair not in GIVEN_BY_RUN.items()]
    return shlex.join(["./run", "report", scene, *words_of(dict(own))])


class RunCommands:
    """The command lines of single runs of one study."""

    def __init__(self, study):
        self.scene = scene_argument(study.sidecar)
        self.until = study.record.until
        self.options = study_options(study.sidecar)
        self.takes = {name: look(note, "takes") for name, note in study.method_notes.items()}

    def of_run(self, method, knob, value):
        """The line that repeats a run of a method at a value of its knob; None where what the run
        was told is not known."""
        options = {name: given for name, given in self.options.items() if name in OF_EVERY_RUN}
        others = {name: given for name, given in self.options.items() if name not in options}
        is_unsure = method not in self.takes and not others.keys() <= set(LISTS)
        if self.scene is None or self.until is None or is_unsure:
            return None
        taken = self.takes.get(method) or []
        options |= {name: given for name, given in others.items() if name in taken}
        words = ["build/bin/simulate", "--scene", self.scene, "--method", method]
        words += [f"--{knob.replace('_', '-')}", repr(value), "--until", repr(self.until)]
        return shlex.join([*words, *words_of(options)])
