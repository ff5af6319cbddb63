"""Random command lines of a program: sensible, at the edge of what is allowed, and spoiled.

The options are those that the program's --help lists, so that a new one is tried without being told.
"""

import math
import re
import subprocess
from dataclasses import dataclass

from hostile_values import EDGE_NUMBERS, EDGE_TEXTS, PATHS
from sensible_values import GENERATORS, NEEDED, OF_A_PROGRAM, SENSIBLE

# "  -h,--help   words", "  --until FLOAT=2 ...   words", and the words alone on the next line.
_LINE = re.compile(
    r"^  (?:-\w,)?(?P<name>--[\w-]+|[a-z]\w*)"
    r"(?: (?P<kind>[A-Z]{2,}))?(?:=(?P<default>\[[^\]]*\]|\S+))?(?: \.\.\.)?(?:\s+(?P<words>.*))?$"
)


@dataclass(frozen=True)
class Option:
    """One option: `kind` is INT, FLOAT, TEXT or FLAG."""

    name: str
    kind: str
    default: str | None
    words: str

    @property
    def choices(self):
        """The words of a list "... of a, b, c" in the option's description."""
        found = re.search(r"\bof ((?:[a-z]\w+, )+[a-z]\w+)", self.words)
        return found.group(1).split(", ") if found else []


def options_of(program):
    """The options of the executable `program`; raises RuntimeError if its help cannot be read."""
    done = subprocess.run(
        [program, "--help"], capture_output=True, text=True, timeout=60, check=True
    )
    found = filter(None, map(_LINE.match, done.stdout.split("\n")))
    options = [
        Option(m["name"], m["kind"] or "FLAG", m["default"], m["words"] or "")
        for m in found
        if m["name"] not in ("--help", "--version") and (m["name"].startswith("-") or m["kind"])
    ]
    if not options:
        raise RuntimeError(f"{program} --help lists no options")
    return options


def methods_of(simulate):
    """Names of methods by what they take: {"step_size": [...], "rtol": [...]}."""
    words = [simulate, "--list-methods", "--csv"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=True)
    methods = {"step_size": [], "rtol": []}
    for line in done.stdout.splitlines()[1:]:
        name, _, _, knob = line.split(",")[:4]
        methods[knob].append(name)
    return methods


class Commands:
    """Draws command lines for one program from its options and the names of methods by knob."""

    def __init__(self, program, options, methods):
        self.program, self.options, self.methods = program, options, methods

    def _method_list(self, random):
        names = self.methods["step_size"] * 2 + self.methods["rtol"]
        if self.program == "stock_sundials":
            names = [name for name in self.methods["rtol"] if name + "_klu" in self.methods["rtol"]]
        elif self.program in ("convergence", "reversal", "exchange", "scaling"):
            names = self.methods["step_size"]
        return ",".join(random.choice(names) for _ in range(random.randint(1, 2)))

    def sensible(self, random, option):
        """A value that should be fine, as text."""
        rule = OF_A_PROGRAM.get((self.program, option.name)) or SENSIBLE.get(option.name)
        scene = random.choice(GENERATORS) if random.random() < 0.1 else "scene.toml"
        own = option.name.removeprefix("--")
        match rule:
            case list():
                return random.choice(rule)
            case (low, high):
                return f"{math.exp(random.uniform(math.log(low), math.log(high))):.3g}"
            case "scene":
                return scene
            case "scenes":
                return scene + "@0.005"
            case "methods":
                return self._method_list(random)
            case "folder":
                return random.choice(["new"] * 4 + ["folder", "results", "mine", "."])
            case "file":
                return random.choice(["new.csv", "folder/new.csv", "end.csv"] + [own + ".csv"] * 5)
        if option.choices:
            return random.choice(option.choices)
        if option.default and random.random() < 0.5:
            return option.default.strip("[]")
        return {"INT": "1", "FLOAT": "0.1"}.get(option.kind, random.choice(PATHS))

    def hostile(self, random, option):
        """A value that may well be refused: of another kind, too large, a path of trouble,
        spoiled."""
        kind = random.random()
        if kind > 0.97:
            text = self.sensible(random, option)
            at = random.randrange(len(text) + 1)
            junk = random.choice(["\x1b", "é", "0", "-", ",", " ", "$", "\udc80", "e9"])
            return text[:at] + junk + text[at:]
        if option.kind != "TEXT":
            return random.choice(EDGE_NUMBERS if kind < 0.85 else EDGE_TEXTS)
        return random.choice(PATHS if kind < 0.6 else EDGE_TEXTS if kind < 0.9 else EDGE_NUMBERS)

    def _forced(self, random):
        """The options without which simulate only refuses."""
        if self.program != "simulate":
            return {}
        knob = random.choice(["step_size", "rtol"])
        outputs = ["--final", "--trajectory", "--energy", "--motion", "--write-scene"]
        chosen = random.sample(outputs, random.choice([0, 1, 1, 2]))
        if {"--trajectory", "--energy", "--motion"} & set(chosen):
            chosen.append("--every")
        chosen.append("--" + knob.replace("_", "-"))
        return dict.fromkeys(chosen) | {"--method": random.choice(self.methods[knob])}

    def draw(self, random):
        """The arguments behind the program's name."""
        forced, rare = self._forced(random), {"--explain", "--list-methods", "--list-scenes"}
        if forced:
            rare |= {"--step-size", "--rtol", "--every", "--method"}
        given = []
        for option in self.options:
            is_needed = option.name in NEEDED or (self.program, option.name) in NEEDED
            chance = 0.99 if is_needed else 0.3 / len(self.options)
            if option.name in rare:
                chance = 0.01
            if option.name in forced or random.random() < chance:
                given.append((option, forced.get(option.name) or self.sensible(random, option)))
        random.shuffle(given)
        given.sort(key=lambda one: one[0].name == "--every")
        for _ in range(random.choice([0, 0, 0, 1, 1, 1, 2, 3])):
            given = self._altered(random, given)
        return self._spelled(random, given)

    def _altered(self, random, given):
        """The options with one hostile, added, left out or repeated."""
        at, what = random.randrange(max(1, len(given))), random.random()
        if what >= 0.88 and given:
            return given[:at] + given[at + 1 :] if what < 0.95 else given + [given[at]]
        if what < 0.65 and given:
            option = given[at][0]
            return given[:at] + [(option, self.hostile(random, option))] + given[at + 1 :]
        there = {option.name for option, _ in given}
        option = random.choice([o for o in self.options if o.name not in there] or self.options)
        value = self.hostile if random.random() < 0.6 else self.sensible
        return given + [(option, value(random, option))]

    def _spelled(self, random, given):
        arguments = []
        for option, value in given:
            if not option.name.startswith("--"):
                arguments.append(value)
            elif option.kind == "FLAG":
                arguments.append(option.name)
            elif random.random() < 0.05:
                arguments.append(f"{option.name}={value}")
            else:
                arguments += [option.name, value]
        if random.random() < 0.03 and arguments:
            at = random.randrange(len(arguments))
            word = arguments[at]
            arguments[at] = random.choice([word[:-1], word + "x", random.choice(EDGE_TEXTS)])
        return arguments
