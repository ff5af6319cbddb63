"""Which processor measures: figures name it, since they hold on no other."""

import re
from pathlib import Path

# Generations of AMD's by family and models: virtual machines hide the model's name.
GENERATIONS = (
    (25, range(0x10, 0x20), "Zen 4"),
    (25, range(0x60, 0x80), "Zen 4"),
    (25, range(0xA0, 0xB0), "Zen 4"),
    (25, range(0x00, 0x100), "Zen 3"),
    (26, range(0x00, 0x100), "Zen 5"),
)


def processor():
    """The name that the processor gives itself and, where that hides it, its generation: AMD EPYC
    (Zen 4)."""
    first = Path("/proc/cpuinfo").read_text(encoding="utf-8").partition("\n\n")[0]
    facts = dict(re.split(r"\s*:\s*", line, maxsplit=1) for line in first.splitlines())
    name = facts.get("model name", "unknown processor")
    if facts.get("vendor_id") == "AuthenticAMD":
        for family, models, generation in GENERATIONS:
            if int(facts["cpu family"]) == family and int(facts["model"]) in models:
                return f"{name} ({generation})"
    return name
