"""Checks that many solves leak nothing."""

import gc
import sys
import unittest

import numpy as np

import problems
import qddot

COUNT = 4000
# A page now and then is the allocator's; a leak of one array header alone is 100 bytes a solve.
MOST_BYTES_A_SOLVE = 16


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


def failing(q, f):
    raise ArithmeticError("as it should")


class Leaks(unittest.TestCase):
    def hold(self, name, solve):
        for _ in range(COUNT // 4):
            solve()
        gc.collect()
        objects, before = len(gc.get_objects()), resident()
        for _ in range(COUNT):
            solve()
        gc.collect()
        growth = resident() - before
        print(f"{name}: {COUNT} solves, {growth / COUNT:.1f} bytes each", file=sys.stderr)
        self.assertLess(growth, MOST_BYTES_A_SOLVE * COUNT + 300_000, name)
        self.assertLess(len(gc.get_objects()) - objects, 50, name)

    def test_none_leaks(self):
        pair, stiff = qddot.scenes.pair(), qddot.scenes.oscillator()
        bad = qddot.System(np.ones(3), failing, check=False)
        forces = problems.duffing_force, problems.duffing_potential, problems.duffing_stiffness
        made = lambda: qddot.System(np.ones(3), *forces)
        system = made()
        short = dict(step_size=1e-3, until=0.01, save_at=np.linspace(0, 0.01, 5))
        own = dict(until=0.02, q0=np.ones(3))
        coarse = dict(step_size=1e-2, **own)
        for name, solve in {
            "a scene": lambda: qddot.solve(pair, "verlet", **short),
            "scenes": lambda: qddot.solve(qddot.scenes.pair(), "implicit_euler", **short),
            "a system": lambda: qddot.solve(system, "dprkn8", rtol=1e-6, **own),
            "K": lambda: qddot.solve(system, "semi_implicit_euler", step_size=5e-3, **own),
            "SUNDIALS": lambda: qddot.solve(system, "cvode_bdf", rtol=1e-4, **own),
            "systems": lambda: qddot.solve(made(), "verlet", **coarse),
            "what callables raise": lambda: self.assertRaises(
                ArithmeticError, qddot.solve, bad, "verlet", **coarse
            ),
            "runs that fail": lambda: qddot.solve(stiff, "verlet", step_size=1, until=1e3),
            "refusals": lambda: self.assertRaises(ValueError, qddot.solve, stiff, "none"),
        }.items():
            with self.subTest(name):
                self.hold(name, solve)
