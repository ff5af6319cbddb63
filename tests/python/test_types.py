"""The stub is the extension's, and the layer is typed as it says."""

import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

import qddot
from programs import Programs, write

PACKAGE = os.path.dirname(qddot.__file__)
# Members that pybind11 gives every class; the module's typed interface cannot name them.
ALLOWED = r"""
qddot\._qddot\.(Drawn|Model|Reference|Scene)
qddot\._qddot\.(Drawn|Model|Reference|Scene)\.__init__
"""
USER = """
import numpy as np
import qddot

scene: qddot.Scene = qddot.scenes.cloth(nodes=5)
solution = qddot.solve(scene, "verlet", step_size=1e-3, save_at=[0.0, 0.1])
energy = solution.energy
assert energy is not None
total: float = float(energy.total[0]) + solution.counts.steps
best = qddot.work_precision(scene, methods=["verlet"]).best(1e-4)
name: str = best.method if best else ""
system = qddot.System([1.0], lambda q, f: np.copyto(f, -q), stiffness=[[-1.0]], name="one")
q, v = solution([0.05, 0.1])
along = qddot.reference(scene, 0.1).errors_along(solution)
worst: float = float(along.position.max()) + float(q[0, 0, 0]) + scene.potential(scene.positions)
"""
MISUSE = USER + "solution.energie\n"
MISSPELT = USER + "qddot.solve(scene, 'verlet', dt=1e-3)\n"


@unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
class Types(Programs):
    @classmethod
    def setUpClass(cls):
        cls.cache = cls.enterClassContext(tempfile.TemporaryDirectory())

    def ends(self, status, *words):
        command, place = [sys.executable, "-m", *words], os.path.dirname(PACKAGE)
        environment = {**os.environ, "MYPY_CACHE_DIR": self.cache}
        done = subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)

    def test_the_stub_is_the_extensions(self):
        allowed = os.path.abspath(write("allowed.txt", ALLOWED))
        words = f"mypy.stubtest qddot._qddot --ignore-unused-allowlist --allowlist {allowed}"
        self.ends(0, *words.split())

    def test_the_layer_holds_its_types(self):
        files = [name for name in os.listdir(PACKAGE) if name.endswith(".py")]
        self.ends(0, "mypy", "--strict", *(os.path.join("qddot", f) for f in files))

    def test_users_are_told_by_their_checker(self):
        for text, status in ((USER, 0), (MISUSE, 1), (MISSPELT, 1)):
            self.ends(status, "mypy", "--strict", os.path.abspath(write("user.py", text)))


class Names(unittest.TestCase):
    def test_every_name_says_what_it_is(self):
        for name in qddot.__all__:
            self.assertTrue(hasattr(qddot, name), name)
            if name != "__version__":
                self.assertTrue(getattr(qddot, name).__doc__, name)
