"""Random command lines of a program: sensible, at the edge of what is allowed, and spoiled."""

import math

from hostile_values import EDGE_NUMBERS, EDGE_TEXTS, PATHS
from sensible_values import GENERATORS, NEEDED, OF_A_PROGRAM, SENSIBLE


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

    def _scene(self, random):
        return random.choice(GENERATORS) if random.random() < 0.1 else "scene.toml"

    def sensible(self, random, option):
        """A value that should be fine, as text."""
        rule = OF_A_PROGRAM.get((self.program, option.name)) or SENSIBLE.get(option.name)
        if isinstance(rule, list):
            return random.choice(rule)
        if isinstance(rule, tuple):
            return f"{math.exp(random.uniform(math.log(rule[0]), math.log(rule[1]))):.3g}"
        match rule:
            case "scene":
                return self._scene(random)
            case "scenes":
                return self._scene(random) + "@0.005"
            case "methods":
                return self._method_list(random)
            case "folder":
                return random.choice(["new"] * 4 + ["folder", "results", "mine", "."])
            case "file":
                return random.choice(
                    ["new.csv", "folder/new.csv"] + [option.name[2:] + ".csv"] * 5 + ["end.csv"]
                )
        if option.choices:
            return random.choice(option.choices)
        if option.default and random.random() < 0.5:
            return option.default.strip("[]")
        return {"INT": "1", "FLOAT": "0.1"}.get(option.kind, random.choice(PATHS))

    def hostile(self, random, option):
        """A value that may well be refused: of another kind, too large, a path of trouble,
        spoiled.
        """
        kind = random.random()
        if option.kind != "TEXT":
            pool = EDGE_NUMBERS if kind < 0.85 else EDGE_TEXTS
        else:
            pool = PATHS if kind < 0.6 else EDGE_TEXTS if kind < 0.9 else EDGE_NUMBERS
        if kind > 0.97:
            text = self.sensible(random, option)
            at = random.randrange(len(text) + 1)
            return (
                text[:at]
                + random.choice(["\x1b", "é", "0", "-", ",", " ", "$", "\udc80", "e9"])
                + text[at:]
            )
        return random.choice(pool)

    def _simulate(self, random):
        knob = random.choice(["step_size", "rtol"])
        names = {
            "--method": random.choice(self.methods[knob]),
            "--step-size" if knob == "step_size" else "--rtol": None,
        }
        chosen = random.sample(
            ["--final", "--trajectory", "--energy", "--motion", "--write-scene"],
            random.choice([0, 1, 1, 2]),
        )
        if {"--trajectory", "--energy", "--motion"} & set(chosen):
            chosen.append("--every")
        return names | {name: None for name in chosen}

    def draw(self, random):
        """The arguments behind the program's name, and the names of the options among them."""
        forced = self._simulate(random) if self.program == "simulate" else {}
        given = []
        for option in self.options:
            is_needed = option.name in NEEDED or (self.program, option.name) in NEEDED
            chance = 0.99 if is_needed else 0.3 / len(self.options)
            if option.name in ("--explain", "--list-methods", "--list-scenes"):
                chance = 0.01
            if self.program == "simulate" and option.name in (
                "--step-size",
                "--rtol",
                "--every",
                "--method",
            ):
                chance = 0.01
            if option.name in forced or random.random() < chance:
                given.append((option, forced.get(option.name) or self.sensible(random, option)))
        random.shuffle(given)
        given.sort(key=lambda one: one[0].name == "--every")
        for _ in range(random.choice([0, 0, 0, 1, 1, 1, 2, 3])):
            given = self._altered(random, given)
        return self._spelled(random, given)

    def _altered(self, random, given):
        at = random.randrange(len(given)) if given else 0
        what = random.random()
        if what < 0.65 and given:
            return (
                given[:at] + [(given[at][0], self.hostile(random, given[at][0]))] + given[at + 1 :]
            )
        if what < 0.88 or not given:
            there = {option.name for option, _ in given}
            option = random.choice([o for o in self.options if o.name not in there] or self.options)
            value = (
                self.hostile(random, option)
                if random.random() < 0.6
                else self.sensible(random, option)
            )
            return given + [(option, value)]
        if what < 0.95:
            return given[:at] + given[at + 1 :]
        return given + [given[at]]

    def _spelled(self, random, given):
        arguments = []
        for option, value in given:
            if option.positional:
                arguments.append(value)
            elif option.kind == "FLAG":
                arguments.append(option.name)
            elif random.random() < 0.05:
                arguments.append(f"{option.name}={value}")
            else:
                arguments += [option.name, value]
        if random.random() < 0.03 and arguments:
            at = random.randrange(len(arguments))
            arguments[at] = random.choice(
                [arguments[at][:-1], arguments[at] + "x", random.choice(EDGE_TEXTS)]
            )
        return arguments
