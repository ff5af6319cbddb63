#include <boost/multiprecision/cpp_int.hpp>
#include <boost/test/unit_test.hpp>

#include "tests/integrators/tables.hpp"
#include "tests/symmetric_formulas.hpp"

BOOST_AUTO_TEST_SUITE(symmetric)

using namespace qddot;

namespace {

using Rational = boost::multiprecision::cpp_rational;

// The whole of a palindrome of odd length, exactly.
std::vector<Rational> whole(const std::vector<std::int64_t>& half, std::int64_t denominator) {
  std::vector<Rational> list;
  for (const std::int64_t number : half) list.emplace_back(number, denominator);
  for (std::size_t i = half.size() - 1; i-- > 0;) list.push_back(list[i]);
  return list;
}

// The defect of q = t^p in the formula, with h = 1 and t = 0 in the middle.
Rational defect(const SymmetricFormula& formula, int p) {
  const auto rho = whole(formula.rho, formula.rho_denominator),
             beta = whole(formula.beta, formula.beta_denominator);
  const int middle = formula.steps / 2;
  const auto power = [](int t, int exponent) {
    return Rational(pow(boost::multiprecision::cpp_int(t), static_cast<unsigned>(exponent)));
  };
  Rational sum = 0;
  for (int j = 0; j < std::ssize(rho); ++j) {
    sum += rho[static_cast<std::size_t>(j)] * power(j - middle, p);
  }
  for (int j = 0; p >= 2 && j < std::ssize(beta); ++j) {
    sum -= p * (p - 1) * beta[static_cast<std::size_t>(j)] * power(j + 1 - middle, p - 2);
  }
  return sum;
}

// The positions at the ends of the first `steps` steps of a run.
std::vector<Vec> positions(const char* method, const System& system, const State& start, double h,
                           int steps) {
  std::vector<Vec> list = {start.q};
  Observer observer;
  for (int n = 1; n <= steps; ++n) observer.times.push_back(n * h);
  observer.see = [&](const State& s) { list.push_back(s.q); };
  const Run r = run(method_named(method), system, start, steps * h, {.step_size = h}, observer);
  BOOST_REQUIRE(r.summary.message == "");
  return list;
}

}  // namespace

// A polynomial of degree p + 1 is stepped exactly by a formula of order p; odd ones by symmetry.
BOOST_AUTO_TEST_CASE(each_formula_meets_the_conditions_of_its_order_exactly_and_no_more) {
  for (const auto& [name, formula] : methods_with_tables(&Method::symmetric_formula)) {
    BOOST_TEST_CONTEXT(name) {
      const int order = method_named(name).order;
      BOOST_TEST(order == formula.steps);
      for (int p = 0; p <= order + 1; ++p) BOOST_TEST(defect(formula, p) == 0);
      BOOST_TEST(defect(formula, order + 2) != 0);
    }
  }
}

BOOST_AUTO_TEST_CASE(spurious_roots_are_on_the_unit_circle_where_they_are_said_to_be) {
  for (const auto& [name, formula, cosines] : symmetric_formulas()) {
    std::vector<Rational> product = {1};
    for (const double c : cosines) {
      // times z^2 - 2 c z + 1; each cosine is a fraction with a divisor of 20.
      const Rational twice(std::llround(40 * c), 20);
      std::vector<Rational> next(product.size() + 2);
      for (std::size_t i = 0; i < product.size(); ++i) {
        next[i] += product[i];
        next[i + 1] -= twice * product[i];
        next[i + 2] += product[i];
      }
      product = next;
    }
    const std::vector<double> r = formula.cofactor();
    BOOST_TEST_REQUIRE(r.size() == product.size());
    for (std::size_t i = 0; i < r.size(); ++i) {
      BOOST_TEST(r[i] == static_cast<double>(product[i]), name << " r_" << i);
    }
  }
}

// Without a force every step is as long as the one before; with one, the formula itself.
BOOST_AUTO_TEST_CASE(runs_obey_the_formula_on_a_nonlinear_network) {
  const Problem p = hammock(3);
  const auto system = make_mass_spring(p.network);
  constexpr double h = 1. / 64;
  for (const auto& [name, formula, cosines] : symmetric_formulas()) {
    const int k = formula.steps;
    const std::vector<double> rho = formula.all_rho(), beta = formula.all_beta();
    const std::vector<Vec> q = positions(name, *system, p.initial, h, 4 * k);
    double worst = 0, smallest_term = 1e300;
    for (std::size_t n = 0; n + rho.size() <= q.size(); ++n) {
      Vec left = Vec::Zero(system->size()), right = left;
      for (std::size_t j = 0; j < rho.size(); ++j) left += rho[j] * q[n + j];
      for (std::size_t j = 0; j < beta.size(); ++j) {
        const Vec& at = q[n + j + 1];
        right += h * h * beta[j] * force_at(*system, at).cwiseQuotient(system->mass());
      }
      worst = std::max(worst, (left - right).lpNorm<Eigen::Infinity>());
      smallest_term = std::min(smallest_term, right.lpNorm<Eigen::Infinity>());
    }
    // Positions of some 5 m are rounded, and summed with coefficients of up to 12.
    BOOST_TEST(worst < 12 * 12 * 5 * 2.2e-16, name << ": " << worst);
    BOOST_TEST(smallest_term > 1e-6);
  }
}

// Weights of m accelerations are exact where these are polynomials of degree m - 1 in time: for
// q = (-s)^(p+2), g = (p + 2)(p + 1)(-s)^p at the times -s of steps of 1 s, at t = 0.
BOOST_AUTO_TEST_CASE(velocities_are_exact_for_polynomials) {
  for (const int first : {0, 1}) {
    for (int count = 1; count <= 11; ++count) {
      const std::vector<double> w = velocity_weights(first, count);
      for (int p = 0; p <= count; ++p) {
        double sum = p % 2 == 0 ? -1 : 1, size = 1;  // q(0) - q(-1); the velocity is zero
        for (int j = 0; j < count; ++j) {
          const double term = (p + 2) * (p + 1) * std::pow(-(first + j), p);
          sum += w[static_cast<std::size_t>(j)] * term;
          size += std::abs(w[static_cast<std::size_t>(j)] * term);
        }
        BOOST_TEST_CONTEXT(first << " " << count << " " << p) {
          if (p < count) BOOST_TEST(std::abs(sum) < 1e-15 * size);
          if (p == count && first == 0) BOOST_TEST(std::abs(sum) > 1e-3);  // the next power is not
        }
      }
    }
  }
}

// A position of an oscillator is a combination of the powers of the recurrence's roots: the product
// of all factors (E - z) makes it zero.
BOOST_AUTO_TEST_CASE(roots_are_those_of_the_recurrence_of_a_run) {
  const auto system = make_mass_spring(Oscillator{.mass = 1, .stiffness = 1}.problem().network);
  const State start{0, Vec::Constant(1, 0.3), Vec::Constant(1, 0.7)};
  for (const auto& [name, formula, cosines] : symmetric_formulas()) {
    for (const double hw : {0.1, 0.5, 0.75, 2.0}) {
      std::vector<std::complex<double>> factor = {1};
      for (const auto root : roots_of(formula, hw)) {
        factor.push_back(0);
        for (std::size_t i = factor.size() - 1; i > 0; --i) factor[i] -= root * factor[i - 1];
      }
      const std::vector<Vec> q = positions(name, *system, start, hw, 3 * formula.steps);
      for (std::size_t n = 0; n + factor.size() <= q.size(); ++n) {
        std::complex<double> sum = 0;
        double size = 0;
        for (std::size_t j = 0; j < factor.size(); ++j) {
          const double at = q[n + factor.size() - 1 - j][0];
          sum += factor[j] * at;
          size = std::max(size, std::abs(factor[j] * at));
        }
        // Roots are known to 1e-14 or, where two are near each other, to the root of that.
        BOOST_TEST(std::abs(sum) < 1e-11 * size, name << " " << hw << ": " << std::abs(sum));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_step_costs_one_force_after_those_of_the_start) {
  const Problem p = hammock(2);
  for (const auto& [name, formula, cosines] : symmetric_formulas()) {
    const auto forces = [&, method = method_named(name)](int steps) {
      return run(method, p, steps / 64., {.step_size = 1. / 64}).summary.counts.force_evaluations;
    };
    const int k = formula.steps;
    BOOST_TEST(forces(2 * k) - forces(k) == k);
    // Forces: one at the start, k - 1 in each sweep, one for each of its steps. The step after them
    // begins with the last force; its own force is for the velocity at its end.
    BOOST_TEST(forces(k) == 1 + k / 2 * (k - 1) + 1);
  }
}

BOOST_AUTO_TEST_SUITE_END()
