#!/usr/bin/env python3
"""Checks from every #include that folders (rooms) include only the rooms that the plan allows, and
finds types and inline functions that are defined twice under one name, which no compiler sees.

The table below is the plan: each room with the rooms that it may include, beside itself and all
that those may include. If two definitions share a function, the linker keeps one copy of it, and
unoptimised code then calls it for the other, too. Reads formatted code: declarations of a namespace
start their line. Call: check_rooms.py ROOT [--arrows]; --arrows prints the includes.
"""

import re
import sys
from pathlib import Path

MODEL = {"src/qddot/model", "src/qddot/model/kernels"}
ALGEBRA = MODEL | {"src/qddot/algebra", "src/qddot/algebra/multifrontal"}
ANALYSIS = ALGEBRA | {"src/qddot/analysis"}
SCENE = ANALYSIS | {"src/qddot/scene", "src/qddot/scene/generators", "src/qddot/scene/mesh", "src/qddot/scene/reduce"}
FACE = ANALYSIS | {"src/qddot/integrators"}  # never a scene
BASE = FACE | {"src/qddot/integrators/base"}
MOTION = BASE | SCENE | {"src/qddot/measure/motion"}
REFERENCE = MOTION | {"src/qddot/measure/reference"}
STABILITY = MOTION | {"src/qddot/measure/stability"}
SPEED = REFERENCE | STABILITY | {"src/qddot/measure/speed"}
ADVICE = SPEED | {"src/qddot/measure/advice"}
TREND = SPEED | {"src/qddot/measure/trend"}
EXCHANGE = SPEED | {"src/qddot/measure/exchange"}
KIT = TREND | ADVICE | EXCHANGE | {"experiments/record", "experiments/kit"}
VECTORS = "src/qddot/model/kernels/vectors"

MAY_SEE = {
    **{room: MODEL for room in MODEL},
    **{room: ALGEBRA for room in ALGEBRA - MODEL},
    **{room: ANALYSIS for room in ANALYSIS - ALGEBRA},
    **{room: SCENE for room in SCENE - ANALYSIS},
    "src/qddot/integrators": FACE,
    "src/qddot/integrators/base": BASE,
    "integrators/methods": BASE,
    "integrators/sundials": BASE,
    "src/qddot/measure/motion": MOTION,
    "src/qddot/measure/reference": REFERENCE,
    "src/qddot/measure/stability": STABILITY,
    "src/qddot/measure/speed": SPEED,
    "src/qddot/measure/trend": TREND,
    "src/qddot/measure/advice": ADVICE,
    "src/qddot/measure/exchange": EXCHANGE,
    "experiments/record": SPEED,
    "experiments/kit": KIT,
    "python/extension": KIT - {"experiments/kit"},
    # Compiled for more than one processor: seen by each other only, and see what is plain data.
    VECTORS: {"src/qddot/model/kernels"},
    "src/qddot/algebra/multifrontal/vectors": {VECTORS, "src/qddot/algebra/multifrontal"},
    "src/qddot/measure/speed/vectors": {VECTORS, "src/qddot/measure/speed"},
    # Those that write motions.
    "experiments/simulate": KIT | {"experiments/motion_files"},
    "experiments/motions": KIT | {"experiments/motion_files"},
    # Compares the formulas of methods.
    "experiments/symmetric_roots": KIT | {"integrators/methods"},
    # A peer is SUNDIALS by itself, whose handles are there.
    "experiments/bench": KIT | {"integrators/sundials"},
}
# Code that a library of data in, data out may not have.
NOT_IN_A_LIBRARY = re.compile(r"#include <(CLI/|nlohmann/)|fmt::print|std::c(out|err)\b|\bprintf\(")

INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)

OPENS = re.compile(r"^(?:inline )?namespace(?: (\w[\w: ]*))? \{$")
CLOSES = re.compile(r"^\}  // namespace")
SUITE = re.compile(r"^BOOST_(?:AUTO|FIXTURE)_TEST_SUITE\((\w+)")
SUITE_ENDS = re.compile(r"^BOOST_AUTO_TEST_SUITE_END")
TYPE = re.compile(
    r"^(?:template <.*> )?(?:struct|class|enum class|union) (?:\[\[\w+\]\] )?([\w:]+)\b(?!.*;$)(?!<)"
)
INLINE = re.compile(r"^(?:constexpr|inline) .*\)(?: const)?(?= \{)")


def path_of(name):
    """The file that an include names, from the root."""
    return "src/" + name if name.startswith("qddot/") else name


def may_see(room):
    """A question sees the command line and the measurements, and never another question."""
    return MAY_SEE.get(room, KIT) | {room}


def check(root):
    """The arrows between rooms, and a sentence for each that the plan does not have."""
    arrows, wrong = {}, []
    for top in ("src", "integrators", "experiments", "python"):
        for file in sorted((root / top).rglob("*.[ch]pp")):
            room = str(file.parent.relative_to(root))
            text = file.read_text()
            place = file.relative_to(root)
            for name in INCLUDE.findall(text):
                target = path_of(name)
                if not (root / target).is_file():
                    wrong.append(f"{place} includes {name}, which no room has")
                    continue
                seen = str(Path(target).parent)
                if seen != room:
                    arrows.setdefault((room, seen), []).append(f"{place} -> {target}")
                if seen not in may_see(room):
                    wrong.append(f"{place} includes {target}: {room} may not see {seen}")
            is_library = top != "experiments"
            if is_library and (found := NOT_IN_A_LIBRARY.search(text)):
                wrong.append(f"{place} has {found[0]}: a library takes data and returns data")
    return arrows, wrong


def definitions(text):
    """The qualified names of the types that a file defines for others to see, and the signatures of
    its inline functions."""
    spaces = []
    for line in text.splitlines():
        if opened := OPENS.match(line):
            spaces.append(opened[1] and opened[1].replace("inline ", ""))  # None: nobody sees it
        elif suite := SUITE.match(line):
            spaces.append(suite[1])
        elif CLOSES.match(line) or SUITE_ENDS.match(line):
            spaces.pop()
        elif None not in spaces:
            if found := TYPE.match(line):
                yield "::".join([*spaces, found[1]])
            elif found := INLINE.match(line):
                yield "::".join([*spaces, found[0]])


def defined_twice(root):
    """A sentence for each name that has two definitions."""
    places = {}
    for top in ("src", "integrators", "experiments", "tests"):
        for file in sorted((root / top).rglob("*.[ch]pp")):
            for name in definitions(file.read_text()):
                places.setdefault(name, []).append(str(file.relative_to(root)))
    for name, files in places.items():
        if len(files) > 1:
            yield f"{name} is defined in {' and in '.join(files)}"


def main(arguments):
    root = Path(arguments[0])
    arrows, wrong = check(root)
    wrong += defined_twice(root)
    if not arrows:
        wrong.append(f"{root} has no includes: is it the root of the tree?")
    if "--arrows" in arguments:
        for (room, seen), places in sorted(arrows.items()):
            print(f"{room} -> {seen} ({len(places)})")
        rooms = {room for arrow in arrows for room in arrow}
        print(f"{len(rooms)} rooms, {len(arrows)} arrows")
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
