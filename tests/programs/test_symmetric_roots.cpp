#include <cmath>

#include <boost/test/unit_test.hpp>

#include "experiments/symmetric_roots/formula.hpp"
#include "experiments/symmetric_roots/orbit_swing.hpp"
#include "qddot/integrators/base/symmetric_formula.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/symmetric_formulas.hpp"

BOOST_AUTO_TEST_SUITE(symmetric_roots)

using namespace qddot;
using namespace qddot::spurious_roots;

namespace {

// The largest difference of two lists of equal lengths.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  BOOST_TEST_REQUIRE(a.size() == b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

// The defect of q = t^p in the formula, with h = 1 and t = 0 in the middle, over the sum of all
// terms' sizes.
double relative_defect(const Coefficients& formula, int p) {
  const int middle = formula.steps() / 2;
  double sum = 0, size = 0;
  for (int j = 0; j < std::ssize(formula.rho); ++j) {
    const double term = formula.rho[static_cast<std::size_t>(j)] * std::pow(j - middle, p);
    sum += term;
    size += std::abs(term);
  }
  for (int j = 0; p >= 2 && j < std::ssize(formula.beta); ++j) {
    const double term =
        p * (p - 1) * formula.beta[static_cast<std::size_t>(j)] * std::pow(j + 1 - middle, p - 2);
    sum -= term;
    size += std::abs(term);
  }
  return std::abs(sum) / size;
}

// How far the recurrence's roots are off the unit circle at h w, as their cosines show it.
double off_circle(const Coefficients& formula, double h_omega) {
  std::vector<double> sum = formula.rho;
  for (std::size_t j = 0; j < formula.beta.size(); ++j) {
    sum[j + 1] += h_omega * h_omega * formula.beta[j];
  }
  double worst = 0;
  for (const auto y : cosines_of_roots(sum)) {
    worst = std::max({worst, std::abs(y.imag()), std::abs(y.real()) - 1});
  }
  return worst;
}

}  // namespace

BOOST_AUTO_TEST_CASE(cosines_make_the_coefficients_of_the_registry) {
  for (const auto& [name, formula, cosines] : symmetric_formulas()) {
    const Coefficients made = formula_of_cosines(cosines), exact = coefficients_of(formula);
    BOOST_TEST(made.steps() == formula.steps);
    // Cosines such as 0.6 are rounded by 1e-16, and coefficients are up to 20 and depend on them as
    // much.
    BOOST_TEST(largest_difference(made.rho, exact.rho) < 1e-14, name);
    BOOST_TEST(largest_difference(made.beta, exact.beta) < 1e-14, name);
  }
}

// A polynomial of degree k + 1 is stepped exactly by a formula of order k.
BOOST_AUTO_TEST_CASE(formulas_of_any_cosines_have_the_order_of_their_steps) {
  for (int pairs = 1; pairs <= 5; ++pairs) {
    for (int i = 1; i <= 100; ++i) {
      const Coefficients formula = formula_of_cosines(sampled_cosines(i, pairs));
      const int k = formula.steps();
      BOOST_TEST_REQUIRE(k == 2 * pairs + 2);
      // Some 25 terms, each with coefficients rounded by 1e-16.
      for (int p = 0; p <= k + 1; ++p) BOOST_TEST(relative_defect(formula, p) < 25 * 2.2e-16);
      // The constant of the error is 1e-3 to 1e-5, and the sum of all terms 12 times larger.
      BOOST_TEST(relative_defect(formula, k + 2) > 1e-8);
    }
  }
}

BOOST_AUTO_TEST_CASE(spurious_roots_have_the_cosines_they_are_made_of) {
  for (int pairs = 1; pairs <= 5; ++pairs) {
    const std::vector<double> cosines = sampled_cosines(7, pairs);
    std::vector<double> angles = root_angles(formula_of_cosines(cosines), 0);
    BOOST_TEST_REQUIRE(angles.size() == cosines.size() + 1);
    // The motion's own double root is known to the root of the rounding.
    BOOST_TEST(angles[0] < 1e-6);
    for (std::size_t i = 0; i < cosines.size(); ++i) {
      // For roots 0.1 apart, a product of up to four such distances divides the rounding.
      BOOST_TEST(std::abs(std::cos(angles[i + 1]) - cosines[i]) < 1e-11);
    }
  }
}

BOOST_AUTO_TEST_CASE(limits_are_those_that_the_registry_declares) {
  for (const auto& [name, formula, cosines] : symmetric_formulas()) {
    const double declared = find_method(name)->stability_limit.value();
    // An extremum moves by the square of what its place is off by, so that rounding is all.
    BOOST_TEST(std::abs(stability_limit(coefficients_of(formula)) - declared) < 1e-13, name);
    BOOST_TEST(std::abs(stability_limit(formula_of_cosines(cosines)) - declared) < 1e-13, name);
  }
}

BOOST_AUTO_TEST_CASE(roots_stay_on_the_circle_up_to_the_limit_and_leave_it_there) {
  for (int pairs = 1; pairs <= 5; ++pairs) {
    for (int i = 1; i <= 60; ++i) {
      const Coefficients formula = formula_of_cosines(sampled_cosines(i, pairs));
      const double limit = stability_limit(formula);
      for (int part = 1; part < 20; ++part) {
        // A real cosine comes out as a real number.
        BOOST_TEST(off_circle(formula, limit * part / 20) == 0);
      }
      BOOST_TEST(off_circle(formula, 0.9999 * limit) == 0);
      BOOST_TEST(off_circle(formula, 1.0001 * limit) > 0);
    }
  }
}

// symmetric4 gives 3 x - 4 x^2 = h^2 w^2 (3/2 - 9/4 x) in x = 1 - cos(theta).
BOOST_AUTO_TEST_CASE(angles_are_those_of_a_quadratic_equation_for_four_steps) {
  const Coefficients formula = coefficients_of(registered::symmetric4_formula());
  for (const double hw : {0.1, 0.4, 1.2, 1.8}) {
    const double b = 3 + 2.25 * hw * hw, root = std::sqrt(b * b - 24 * hw * hw);
    const double own = std::acos(1 - (b - root) / 8), spurious = std::acos(1 - (b + root) / 8);
    // The angle of a cosine near 1 is known to the rounding over the angle.
    BOOST_TEST(std::abs(phase_error(formula, hw) - std::abs(own / hw - 1)) < 1e-13);
    BOOST_TEST(std::abs(root_gap(formula, {hw}) - std::min(spurious - own, 2 * (M_PI - spurious))) <
               1e-13);
  }
  BOOST_TEST(root_gap(formula, {0.1, 1.2, 0.4}) == root_gap(formula, {1.2}));
}

BOOST_AUTO_TEST_CASE(the_orbit_does_what_it_does_in_runs_of_the_methods) {
  const Model scene(load_scene("orbit"));
  constexpr double omega = 10, at = 0.2;  // [rad/s]
  constexpr int steps = 2000;
  const OrbitSwing orbit(at, steps, 12);
  // All of the energy is kinetic where the spring is as long as at rest.
  const double energy = scene.energy(scene.initial());
  for (const auto& [name, formula, cosines] : symmetric_formulas()) {
    double worst = 0;
    for (int i = 1; i <= 8; ++i) {
      const double h = at / 2 * (1 + i / 8.) / omega;
      Observer observer;
      for (int n = 1; n < steps; ++n) observer.times.push_back(n * h);
      observer.see = [&](const State& seen) {
        worst = std::max(worst, std::abs(scene.energy(seen) - energy) / energy);
      };
      State state = scene.initial();
      make_integrator(*find_method(name), scene.system(), {.step_size = h})
          ->advance(state, observer.times.back(), observer);
    }
    // Runs begin with steps of their own errors, which spurious roots keep.
    BOOST_TEST(std::abs(orbit(coefficients_of(formula)) / worst - 1) < 0.1,
               name << " " << orbit(coefficients_of(formula)) << " " << worst);
  }
}

BOOST_AUTO_TEST_CASE(roots_near_each_other_make_an_orbit_grow) {
  const OrbitSwing orbit(0.4, 5000, 12);
  BOOST_TEST(orbit(formula_of_cosines({0, -0.5})) < 0.01);
  BOOST_TEST(orbit(formula_of_cosines({-0.235, -0.288})) == 1);
}

BOOST_AUTO_TEST_CASE(samples_are_mirrored_digits_in_descending_order) {
  // 1 is 0.1 in binary and in base 3; 6 is 110 and 20, mirrored 0.011 and 0.02.
  // Rounded a few times.
  BOOST_TEST(largest_difference(sampled_cosines(1, 2), {-1 + 1.95 / 2, -1 + 1.95 / 3}) < 1e-15);
  BOOST_TEST(largest_difference(sampled_cosines(6, 2), {-1 + 1.95 * 3 / 8, -1 + 1.95 * 2 / 9}) <
             1e-15);
  for (int i = 1; i <= 1000; ++i) {
    const std::vector<double> cosines = sampled_cosines(i, 5);
    BOOST_TEST_REQUIRE(cosines.size() == 5U);
    BOOST_TEST(std::ranges::is_sorted(cosines, std::greater()));
    BOOST_TEST((cosines.front() < 0.95 && cosines.back() > -1));
  }
}

BOOST_AUTO_TEST_SUITE_END()
