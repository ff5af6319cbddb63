"""Runs are the same to the bit at every width of the kernels and with all kinds of roots.

Springs are added in the same order at every width, all operations are the same, and so are roots
and quotients. The lowest level has no fused products and rounds otherwise.
"""

import os

from programs import Programs, read, run

RUNS = (
    "cloth --method verlet --step-size 2e-4 --until 0.1",
    "cloth --method blanes_moan4 --step-size 1e-3 --no-reduce dimension,mirror --until 0.1",
    "cloth --method symmetric8 --step-size 2e-4 --until 0.1",
    "cloth --method implicit_midpoint --step-size 2e-3 --until 0.1",
    "cloth --method dprkn8 --rtol 1e-5 --until 0.1",
    "lattice --method verlet --step-size 2e-5 --until 0.02",
    "lattice --method linear_midpoint --step-size 1e-3 --until 0.02",
    "chain --method symmetric6 --step-size 1e-5 --until 0.02",
    "framed_cloth --method linear_midpoint --step-size 1e-3 --until 0.02",
    "fpu --method verlet --step-size 1e-2 --until 10",
)


class Kernels(Programs):
    def end_of(self, level, roots, line):
        """The nodes at the end; empty where the processor has no such kernels."""
        names = {"QDDOT_KERNELS": level, "QDDOT_ROOTS": roots}
        ended = run(f"simulate --force --final end.csv --scene {line}", env=os.environ | names)
        if ended.returncode != 0:
            self.assertIn("this processor", ended.stderr)
            return ""
        return read("end.csv")

    def test_each_level_and_kind_of_roots(self):
        for line in RUNS:
            expected = self.end_of("v3", "processor", line)
            for level in ("v3", "v4"):
                for roots in ("processor", "estimated_root", "estimated"):
                    with self.subTest(f"{line}, {level}, {roots}"):
                        self.assertIn(self.end_of(level, roots, line), ("", expected))
