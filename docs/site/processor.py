"""Which processor measures: figures name it, since they hold on no other."""

import re
from pathlib import Path

# Generations by vendor, family and models: virtual machines hide the model's name.
GENERATIONS = (
    ("AuthenticAMD", 25, range(0x10, 0x20), "Zen 4"),
    ("AuthenticAMD", 25, range(0x60, 0x80), "Zen 4"),
    ("AuthenticAMD", 25, range(0xA0, 0xB0), "Zen 4"),
    ("AuthenticAMD", 25, range(0x00, 0x100), "Zen 3"),
    ("AuthenticAMD", 26, range(0x00, 0x100), "Zen 5"),
    ("GenuineIntel", 6, (0x6A, 0x6C), "Ice Lake"),
    ("GenuineIntel", 6, (0x8F,), "Sapphire Rapids"),
    ("GenuineIntel", 6, (0xCF,), "Emerald Rapids"),
    ("GenuineIntel", 6, (0xAD, 0xAE), "Granite Rapids"),
)


def processor():
    """The name that the processor gives itself and, where that hides it, its generation: AMD EPYC
    (Zen 4)."""
    first = Path("/proc/cpuinfo").read_text(encoding="utf-8").partition("\n\n")[0]
    facts = dict(re.split(r"\s*:\s*", line, maxsplit=1) for line in first.splitlines())
    name = re.sub(r"\((R|TM)\)| Processor\b", "", facts.get("model name", "unknown processor"))
    for vendor, family, models, generation in GENERATIONS:
        if (facts.get("vendor_id"), facts.get("cpu family")) != (vendor, str(family)):
            continue
        if int(facts["model"]) in models:
            return f"{name} ({generation})"
    return name
