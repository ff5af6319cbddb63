#include <cmath>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/deferred_correction.hpp"
#include "tests/measure.hpp"

BOOST_AUTO_TEST_SUITE(deferred_correction)

using namespace qddot;

namespace {

// q'' = 2 q^3 has the solution q = 1/(2 - t).
double exact_q(double t) { return 1 / (2 - t); }
double exact_v(double t) { return 1 / ((2 - t) * (2 - t)); }

struct Errors {
  double q, v;  // at the end of the steps
  int forces;
};

Errors errors_of(Index steps, double h, int sweeps) {
  DeferredCorrection first(steps, 1);
  int forces = 0;
  const auto acceleration = [&](double t, const Vec& q, MutableVec g) {
    // Each force of a sweep is asked for at the end of its own step.
    BOOST_TEST(std::abs(t / h - (forces == 0 ? 0 : 1 + (forces - 1) % steps)) < 1e-12);
    g = 2 * q.cwiseProduct(q).cwiseProduct(q);
    ++forces;
  };
  const Vec q = Vec::Constant(1, exact_q(0)), v = Vec::Constant(1, exact_v(0));
  Vec g(1);
  acceleration(0, q, g);
  first.compute(q, v, g, h, sweeps, acceleration);
  double end = q[0];
  for (Index j = 0; j < steps; ++j) end += first.d(j)[0];
  const double t = static_cast<double>(steps) * h;
  return {std::abs(end - exact_q(t)), std::abs(first.v(steps)[0] - exact_v(t)), forces};
}

}  // namespace

BOOST_AUTO_TEST_CASE(integrals_are_exact_for_polynomials_up_to_the_number_of_steps) {
  for (const Index steps : {1, 3, 5, 7, 9, 11}) {
    const auto [once, twice] = step_integrals(steps);
    for (Index j = 0; j < steps; ++j) {
      for (Index p = 0; p <= steps + 1; ++p) {
        // The integrals of (t - j)^p from 0 to 1: 1/(p + 1), and with the factor 1 - (t - j)
        // 1/((p + 1)(p + 2)).
        const auto n = static_cast<double>(p + 1);
        double of_once = -1 / n, of_twice = -1 / (n * (n + 1)), size = 1;
        for (Index l = 0; l <= steps; ++l) {
          const double at = std::pow(static_cast<double>(l - j), static_cast<double>(p));
          of_once += once(j, l) * at;
          of_twice += twice(j, l) * at;
          size += std::abs(once(j, l) * at);
        }
        BOOST_TEST_CONTEXT(steps << " " << j << " " << p) {
          // Each weight is rounded once, and so are products and sums.
          const double rounding = 1e-15 * size;
          BOOST_TEST((std::abs(of_once) < rounding) == (p <= steps));
          BOOST_TEST((std::abs(of_twice) < rounding) == (p <= steps));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_first_sweep_is_verlets_method) {
  constexpr double h = 0.1;
  const auto pull = [](double, const Vec& q, MutableVec g) { g = -q.array().sin().matrix(); };
  Vec q = Vec::LinSpaced(5, -1, 1), v = Vec::LinSpaced(5, 2, 3), g(5);
  pull(0, q, g);
  DeferredCorrection first(7, 5);
  first.compute(q, v, g, h, 1, pull);
  for (Index j = 0; j < 7; ++j) {
    v += h / 2 * g;
    // Some ten operations are rounded in another order.
    BOOST_TEST(distance(first.d(j), h * v) < 1e-14);
    q += h * v;
    pull(0, q, g);
    v += h / 2 * g;
    BOOST_TEST(distance(first.g(j + 1), g) < 1e-14);
  }
}

// Over a fixed number of steps a method of order p errs by h^(p+1).
BOOST_AUTO_TEST_CASE(each_sweep_adds_two_orders_until_the_polynomial_is_what_errs) {
  for (const Index steps : {3, 5, 7, 9}) {
    for (int sweeps = 1; 2 * sweeps <= steps + 1; ++sweeps) {
      std::vector<double> h, q, v;
      for (double length = 0.6; length > 0.1; length *= 0.8) {
        const Errors e = errors_of(steps, length / static_cast<double>(steps), sweeps);
        BOOST_TEST(e.forces == 1 + sweeps * steps);
        if (std::min(e.q, e.v) < 1e-14) break;
        h.push_back(std::log(length));
        q.push_back(std::log(e.q));
        v.push_back(std::log(e.v));
      }
      const auto all = [](const std::vector<double>& x) {
        return Vec(Eigen::Map<const Vec>(x.data(), std::ssize(x)));
      };
      BOOST_TEST_REQUIRE(h.size() >= 4);
      // Higher terms still matter here, and make slopes steeper.
      const double order = std::min(slope(all(h), all(q)), slope(all(h), all(v))) - 1;
      BOOST_TEST_CONTEXT(steps << " steps, " << sweeps << " sweeps: " << order) {
        BOOST_TEST(order > 2 * sweeps - 0.2);
        if (sweeps < 3) BOOST_TEST(order < 2 * sweeps + 0.8);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
