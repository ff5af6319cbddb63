"""Own forces with the same K everywhere: exact motions, and what is refused."""

import unittest

import numpy as np

import problems
import qddot
from problems import needs_scipy, scipy

# A saddle in turned axes: a valley of 4 N/m along one, a hill of 9 N/m along the other.
AXES = np.array([[0.6, -0.8], [0.8, 0.6]])
SADDLE = AXES @ np.diag([-4.0, 9.0]) @ AXES.T
# Springs in a row between walls, [N/m].
ROW = -100.0 * (2 * np.eye(5) - np.eye(5, k=1) - np.eye(5, k=-1))
PUSH = np.arange(5.0)


def motion(k, mass, push, q0, v0, t):
    """q(t) and v(t) of m q'' = K q + push, mode by mode."""
    squares, u = np.linalg.eigh(-k / mass)
    y, w, b = u.T @ q0, u.T @ v0, u.T @ (push / mass)
    r = np.sqrt(squares.astype(complex))
    cos, sine = np.cos(r * t).real, (np.sin(r * t) / r).real
    q = u @ (b / squares + (y - b / squares) * cos + w * sine)
    v = u @ (-(y - b / squares) * squares * sine + w * cos)
    return q, v


def system(k, push, mass=2.0, **given):
    def force(q, f):
        f[:] = k @ q + push

    def potential(q):
        return -q @ k @ q / 2 - push @ q

    masses = np.full(len(k), mass)
    return qddot.System(masses, force, potential, **{"stiffness": k, **given})


class LinearSystems(unittest.TestCase):
    @needs_scipy
    def test_exact_is_the_motion_at_every_step(self):
        for k, push, start in (
            (ROW, PUSH, (np.linspace(-1, 1, 5), np.cos(np.arange(5)))),
            (SADDLE, np.array([0.3, -0.2]), (np.array([0.1, 0.2]), np.array([-0.3, 0.1]))),
        ):
            ways = {
                "matrix": {},
                "sparse": dict(stiffness=scipy.sparse.csr_matrix(k)),
                "function": dict(stiffness=lambda q, k=k: k, linear=True),
                "pattern": dict(stiffness=None, pattern=scipy.sparse.csr_matrix(k), linear=True),
            }
            q0, v0 = start
            for name, way in ways.items():
                with self.subTest(way=name, unknowns=len(k)):
                    own = system(k, push, **way)
                    self.assertTrue(own.linear)
                    for steps in (1, 7):
                        run = dict(q0=q0, v0=v0, until=3.0, step_size=3.0 / steps)
                        end = qddot.solve(own, "exact", **run).or_raise().end
                        q, v = motion(k, 2.0, push, q0, v0, 3.0)
                        # K by differences is right to some 1e-10 of it; else rounding is left, and
                        # the saddle's growth by exp(6.4).
                        allowed = 1e-7 if name == "pattern" else 1e-11
                        self.assertLess(np.max(np.abs(end.q - q)), allowed)
                        self.assertLess(np.max(np.abs(end.v - v)), 10 * allowed)

    def test_references_and_answers_of_linear_systems(self):
        for k in (ROW, SADDLE):
            n = len(k)
            own, start = system(k, np.ones(n)), dict(q0=np.full(n, 0.1), v0=np.linspace(0, 1, n))
            exact = qddot.reference(own, 2.0, **start)
            self.assertIn("modal, exact", exact.made_by)
            q, v = motion(k, 2.0, np.ones(n), start["q0"], start["v0"], 2.0)
            self.assertLess(exact.errors(q, v, t=2.0).position, exact.certified.position)
            answer = qddot.solve(own, accuracy=1e-6, until=2.0, **start).or_raise()
            self.assertLessEqual(exact.errors(answer).position, 1e-6)

    def test_k_is_made_once(self):
        calls = []

        def stiffness(q):
            calls.append(1)
            return ROW

        run = dict(q0=np.ones(5), step_size=0.01, until=1.0)
        for linear, times in ((True, 1), (False, 100)):
            own = system(ROW, PUSH, stiffness=stiffness, linear=linear)
            qddot.solve(own, "verlet", **run).or_raise()  # checks it
            calls.clear()
            end = qddot.solve(own, "semi_implicit_euler", **run).or_raise()
            self.assertEqual((end.counts.factorizations, len(calls)), (times, times))

    @needs_scipy
    def test_what_is_not_linear_is_refused(self):
        ones, forces = np.ones(2), (problems.duffing_force, problems.duffing_potential)
        varies = qddot.System(ones, *forces, problems.duffing_stiffness)
        run = dict(step_size=0.1, until=1.0, q0=[1.0, 0.5])
        claims = {
            r"exact needs a K that is the same everywhere: .*linear=True": varies,
            "linear: K is not the same everywhere: .* the force changes": qddot.System(
                ones, *forces, problems.duffing_stiffness, linear=True
            ),
            "linear: K is not the same everywhere: .* the force": qddot.System(
                ones, *forces, pattern=np.eye(2), linear=True
            ),
            # Right beside the start alone.
            "linear: .* K changes": system(
                SADDLE, ones, stiffness=lambda q: SADDLE * (1 + (abs(q[0] - 1) > 0.1)), linear=True
            ),
            "stiffness: beside the start it is not df/dq": system(
                SADDLE, ones, stiffness=2 * SADDLE
            ),
        }
        for sentence, own in claims.items():
            with self.assertRaisesRegex(ValueError, sentence):
                qddot.solve(own, "exact", **run)
        for sentence, given in {
            r"stiffness: its shape is \(3, 3\); allowed is \(2, 2\)": dict(stiffness=np.eye(3)),
            "stiffness: it is not symmetric": dict(stiffness=[[-1.0, 0.5], [0.0, -1.0]]),
            "stiffness: it is not symmetric, as": dict(
                stiffness=scipy.sparse.csr_matrix([[-1.0, 0.5], [0.0, -1.0]])
            ),
            "stiffness: some of its entries": dict(stiffness=np.diag([1.0, np.inf])),
            "linear: the System has no K": dict(linear=True),
        }.items():
            with self.assertRaisesRegex(ValueError, sentence):
                qddot.System(ones, *forces, **given)
        # A matrix is copied: what its owner does later changes nothing.
        k = SADDLE.copy()
        own = system(SADDLE, np.zeros(2), stiffness=k)
        k[:] = 0
        end = qddot.solve(own, "exact", q0=[1.0, 0.0], step_size=1.0, until=1.0).or_raise().end
        expected = motion(SADDLE, 2.0, np.zeros(2), np.array([1.0, 0.0]), np.zeros(2), 1.0)[0]
        self.assertLess(np.max(np.abs(end.q - expected)), 1e-12)


class EnergyTrends(unittest.TestCase):
    def test_an_own_system_has_the_trend_of_its_scene(self):
        chain = problems.Chain(3)
        q0, v0 = chain.start()
        run = dict(step_size=0.02, until=50.0)
        for method in ("verlet", "implicit_euler"):
            a = qddot.energy_trend(chain.scene(), method, **run)
            b = qddot.energy_trend(chain.system(), method, q0=q0, v0=v0, **run)
            self.assertEqual(a.verdict, b.verdict)
            self.assertAlmostEqual(a.energy[0], b.energy[0], delta=1e-9 * abs(a.energy[0]))
            # One motion by two sums of its forces: no more than rounding, which grows with time.
            self.assertLess(np.max(np.abs(a.error - b.error)), 1e-6)
        self.assertEqual(a.verdict, "dissipates")

    def test_without_k_the_energy_is_enough(self):
        forces = problems.duffing_force, problems.duffing_potential
        run = dict(q0=[1.0, -0.5], until=2000.0)
        for method, knob, verdict in (
            ("verlet", dict(step_size=0.1), "bounded"),
            ("rk4", dict(step_size=0.1), "drifts"),
            ("dprkn6", dict(rtol=1e-5), "drifts"),
        ):
            with self.subTest(method):
                bare = qddot.energy_trend(qddot.System([1.0, 1.0], *forces), method, **run, **knob)
                self.assertEqual(bare.verdict, verdict, bare.words)
                own = qddot.System([1.0, 1.0], *forces, problems.duffing_stiffness)
                whole = qddot.energy_trend(own, method, **run, **knob)
                self.assertEqual(whole.verdict, verdict, whole.words)
                # Errors over the largest kinetic energy, which either run has seen.
                ratio = np.max(np.abs(bare.error)) / np.max(np.abs(whole.error))
                self.assertAlmostEqual(ratio, 1, delta=0.01)
        with self.assertRaisesRegex(ValueError, "energy_trend: the System has no V.*'bare'"):
            bare = qddot.System([1.0, 1.0], forces[0], name="bare")
            qddot.energy_trend(bare, "verlet", step_size=0.1, **run)
        with self.assertRaisesRegex(ValueError, "implicit_midpoint needs K"):
            own = qddot.System([1.0, 1.0], *forces)
            qddot.energy_trend(own, "implicit_midpoint", step_size=0.1, **run)
        late = qddot.energy_trend(own, "verlet", step_size=1e-4, seconds=0.1, **run)
        self.assertIn("(seconds = 0.1)", late.words)


if __name__ == "__main__":
    unittest.main()
