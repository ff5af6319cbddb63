"""Answers and their bars on own forces that are weak at first and strong later, against motions in
closed form."""

import unittest

import numpy as np

import qddot

ACCURACIES = [1e-2, 1e-5, 1e-8]


class Planet:
    """A planet of unit mass that starts where it is slowest, about a sun of GM = 1. Kepler's equation
    E - e sin E = n t gives its place."""

    def __init__(self, eccentricity, periods):
        self.e, self.until = eccentricity, 2 * np.pi * periods
        # The semi-axis is 1, and so is the frequency n.
        self.q0 = [-1 - self.e, 0.0]
        self.v0 = [0.0, -np.sqrt((1 - self.e) / (1 + self.e))]
        self.size, self.kinetic = 2.0, 0.5 * (1 + self.e) / (1 - self.e)
        self.system = qddot.System(
            mass=np.ones(2), force=self.force, potential=self.potential, stiffness=self.stiffness
        )

    def force(self, q, f):
        f[:] = -q / np.linalg.norm(q) ** 3

    def potential(self, q):
        return -1 / np.linalg.norm(q)

    def stiffness(self, q):
        r = np.linalg.norm(q)
        return 3 * np.outer(q, q) / r**5 - np.eye(2) / r**3

    def place(self, t):
        anomaly = (t + np.pi) % (2 * np.pi)
        # Bisection: Newton's method leaves the root where e is near 1.
        low, high = 0.0, 2 * np.pi
        for _ in range(60):
            middle = (low + high) / 2
            if middle - self.e * np.sin(middle) < anomaly:
                low = middle
            else:
                high = middle
        at = (low + high) / 2
        return np.array([np.cos(at) - self.e, np.sqrt(1 - self.e**2) * np.sin(at)])


class Bounce:
    """A unit mass in Morse's potential D (1 - exp(-a x))^2, which it leaves almost. exp(a x) swings
    like a sine: Morse, Physical Review 34 (1929), and u = exp(a x) in the energy's equation."""

    def __init__(self, bound, periods):
        self.a, self.d = 3.0, 2.0
        self.root = 1 - bound  # of E / D
        self.w = self.a * np.sqrt(2 * self.d * (1 - self.root**2))
        self.until = 2 * np.pi * periods / self.w
        self.q0, self.v0 = [self.place(0.0)[0]], [0.0]
        self.size, self.kinetic = self.q0[0] - self.place(np.pi / self.w)[0], self.root**2 * self.d
        self.system = qddot.System(
            mass=np.ones(1), force=self.force, potential=self.potential, stiffness=self.stiffness
        )

    def factor(self, q):
        # Steps that are too long leap into the core.
        with np.errstate(over="ignore"):
            return np.exp(-self.a * q)

    def force(self, q, f):
        e = self.factor(q)
        f[:] = -2 * self.a * self.d * (1 - e) * e

    def potential(self, q):
        return float((self.d * (1 - self.factor(q)) ** 2).sum())

    def stiffness(self, q):
        e = self.factor(q)
        return np.diag(2 * self.a**2 * self.d * (e - 2 * e * e))

    def place(self, t):
        return np.array(
            [np.log((1 + self.root * np.cos(self.w * t)) / (1 - self.root**2)) / self.a]
        )


def motions():
    random = np.random.default_rng(1)
    for _ in range(3):
        yield "planet", Planet(1 - 10 ** random.uniform(-3, -0.5), random.uniform(0.6, 4))
        yield "bounce", Bounce(10 ** random.uniform(-4, -1), random.uniform(0.6, 4))


class HardForces(unittest.TestCase):
    def test_answers_are_within_their_accuracy(self):
        beyond = 0
        for name, motion in motions():
            start = dict(q0=motion.q0, v0=motion.v0)
            for accuracy in ACCURACIES:
                with self.subTest(motion=name, until=motion.until, accuracy=accuracy):
                    answer = qddot.solve(
                        motion.system, accuracy=accuracy, until=motion.until, **start
                    ).or_raise()
                    off = np.linalg.norm(np.ravel(answer.end.q) - motion.place(motion.until))
                    error = off / motion.size
                    self.assertLess(error, accuracy)
                    # Bars hold for more than 99 of 100 answers.
                    beyond += error > answer.error_estimate
        self.assertLessEqual(beyond, 1)

    def test_energies_are_kept_on_the_way(self):
        for name, motion in motions():
            start = dict(q0=motion.q0, v0=motion.v0)
            times = np.sort(np.random.default_rng(2).uniform(0, motion.until, 100))
            with self.subTest(motion=name, until=motion.until):
                answer = qddot.solve(
                    motion.system, accuracy=1e-5, accuracy_of="energy", until=motion.until,
                    save_at=times, **start,
                ).or_raise()  # fmt: skip
                total = np.array(answer.energy.total)
                error = np.max(np.abs(total - total[0])) / motion.kinetic
                self.assertLess(error, 1e-5)


if __name__ == "__main__":
    unittest.main()
