#include <array>
#include <functional>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(one_step)

using namespace qddot;

namespace {

using Eigen::MatrixXd;

constexpr double h = 0.01;  // s; h w is up to about 0.3 in these networks

// Rounding of one step. It has some 10 operations on q of 5 m, on v of 5 m/s and on h M^-1 f of 2
// m/s, each with a relative error of 1e-16. A dense solve multiplies it by a condition below 100.
constexpr double rounding = 1e-13;

struct Scene5 {
  std::unique_ptr<System> system;
  State start;
};

// Five masses in each dimension, springs in tension and in compression.
std::vector<Scene5> networks() {
  std::mt19937 random(5);
  std::vector<Scene5> list;
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.9, 1.2}) {
      const Problem p = random_network(random, dimension, 5, stretch);
      list.push_back({make_mass_spring(p.network), p.initial});
    }
  }
  return list;
}

MatrixXd dense_mass(const System& system) { return system.mass().asDiagonal(); }

Vec acceleration(const System& system, const Vec& q) {
  return dense_mass(system).inverse() * force_at(system, q);
}

State explicit_step(const System& system, const State& s) {
  return {h, s.q + h * s.v, s.v + h * acceleration(system, s.q)};
}

State symplectic_step(const System& system, const State& s) {
  const Vec v = s.v + h * acceleration(system, s.q);
  return {h, s.q + h * v, v};
}

State semi_implicit_step(const System& system, const State& s) {
  const MatrixXd m = dense_mass(system);
  const MatrixXd a = m - h * h * dense(stiffness_at(system, s.q));
  const Vec v = a.fullPivLu().solve(m * s.v + h * force_at(system, s.q));
  return {h, s.q + h * v, v};
}

// Steps of any size, also a negative one.
State verlet_step(const System& system, const State& s, double size) {
  const Vec half = s.v + size / 2 * acceleration(system, s.q);
  const Vec q = s.q + size * half;
  return {s.t + size, q, half + size / 2 * acceleration(system, q)};
}

// The first nine of the symmetric 17 of s17odr8a, from Hairer, Lubich and Wanner, Geometric
// Numerical Integration, V.3.2.
constexpr std::array<double, 9> half_gamma = {
    0.13020248308889008087881763, 0.56116298177510838456196441,  -0.38947496264484728640807860,
    0.15884190655515560089621075, -0.39590389413323757733623154, 0.18453964097831570709183254,
    0.25837438768632204729397911, 0.29501172360931029887096624,  -0.60550853383003451169892108};

std::vector<double> all_gamma() {
  std::vector<double> all(half_gamma.begin(), half_gamma.end());
  all.insert(all.end(), half_gamma.rbegin() + 1, half_gamma.rend());
  return all;
}

double sum_of_powers(const std::vector<double>& numbers, int power) {
  double sum = 0;
  for (const double x : numbers) sum += std::pow(x, power);
  return sum;
}

// The method's own step.
State step(const char* method, const Scene5& n) {
  const Run r =
      run(method_named(method), *n.system, n.start, h, {.step_size = h, .solve_tolerance = 1e-13});
  BOOST_REQUIRE(r.summary.message == "");
  return r.state;
}

using Formula = std::function<State(const System&, const State&)>;

// The largest difference of a method's step from a formula, over all networks.
double largest_distance(const char* method, const Formula& formula) {
  double largest = 0;
  for (const Scene5& n : networks()) {
    largest = std::max(largest, distance(step(method, n), formula(*n.system, n.start)));
  }
  return largest;
}

}  // namespace

BOOST_AUTO_TEST_CASE(explicit_euler_is_its_formula) {
  BOOST_TEST(largest_distance("explicit_euler", explicit_step) < rounding);
}

BOOST_AUTO_TEST_CASE(symplectic_euler_is_its_formula) {
  BOOST_TEST(largest_distance("symplectic_euler", symplectic_step) < rounding);
}

BOOST_AUTO_TEST_CASE(semi_implicit_euler_is_its_formula_with_a_dense_solve) {
  BOOST_TEST(largest_distance("semi_implicit_euler", semi_implicit_step) < rounding);
}

BOOST_AUTO_TEST_CASE(verlet_is_its_formula) {
  const auto formula = [](const System& system, const State& s) {
    return verlet_step(system, s, h);
  };
  BOOST_TEST(largest_distance("verlet", formula) < rounding);
}

BOOST_AUTO_TEST_CASE(position_verlet_is_its_formula) {
  const auto formula = [](const System& system, const State& s) -> State {
    const Vec middle = s.q + h / 2 * s.v, v = s.v + h * acceleration(system, middle);
    return {h, middle + h / 2 * v, v};
  };
  BOOST_TEST(largest_distance("position_verlet", formula) < rounding);
}

BOOST_AUTO_TEST_CASE(rk4_is_its_formula_on_the_first_order_form) {
  const auto formula = [](const System& system, const State& s) -> State {
    const Index n = s.q.size();
    const auto rate = [&](const Vec& y) -> Vec {
      Vec change(2 * n);
      change << y.tail(n), acceleration(system, y.head(n));
      return change;
    };
    Vec y(2 * n);
    y << s.q, s.v;
    const Vec k1 = rate(y), k2 = rate(y + h / 2 * k1), k3 = rate(y + h / 2 * k2);
    const Vec end = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(y + h * k3));
    return {h, end.head(n), end.tail(n)};
  };
  BOOST_TEST(largest_distance("rk4", formula) < rounding);
}

BOOST_AUTO_TEST_CASE(kahan_li8_is_17_verlet_steps) {
  const auto formula = [](const System& system, State s) {
    for (const double g : all_gamma()) s = verlet_step(system, s, g * h);
    return s;
  };
  // 17 times the rounding of a step.
  BOOST_TEST(largest_distance("kahan_li8", formula) < 17 * rounding);
}

BOOST_AUTO_TEST_CASE(the_17_sizes_meet_the_conditions_of_order_8_on_sums_of_powers) {
  // Symmetry rules out even orders; of the odd ones each sum of powers has to vanish. Rounding of
  // 17 terms below 1 each.
  BOOST_TEST(std::abs(sum_of_powers(all_gamma(), 1) - 1) < 17 * 1e-16);
  for (const int power : {3, 5, 7}) {
    BOOST_TEST(std::abs(sum_of_powers(all_gamma(), power)) < 17 * 1e-16);
  }
}

BOOST_AUTO_TEST_CASE(implicit_euler_solves_its_equation) {
  for (const Scene5& n : networks()) {
    const State end = step("implicit_euler", n);
    const Vec expected = n.start.v + h * acceleration(*n.system, end.q);
    // Solved to rounding, of q of 5 m over h.
    BOOST_TEST(distance(end.v, expected) < 1e-12);
    BOOST_TEST(distance(end.q, n.start.q + h * end.v) < rounding);
  }
}

BOOST_AUTO_TEST_CASE(implicit_euler_is_at_a_minimum_of_the_incremental_potential) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (const Scene5& n : networks()) {
    const System& system = *n.system;
    const auto objective = [&](const Vec& v) {
      return system.kinetic(v - n.start.v) + system.potential(n.start.q + h * v);
    };
    const State end = step("implicit_euler", n);
    const MatrixXd hessian = dense_mass(system) - h * h * dense(stiffness_at(system, end.q));
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(hessian);
    BOOST_TEST(eigen.eigenvalues().minCoeff() > 0);

    const double least = objective(end.v);
    for (int trial = 0; trial < 100; ++trial) {
      const Vec direction = Vec::NullaryExpr(system.size(), [&] { return normal(random); });
      // 1e-3 m/s in a random direction raises g by about m 1e-6 / 2, far above its rounding.
      BOOST_TEST(objective(end.v + 1e-3 * direction) > least);
    }
    BOOST_TEST(objective(n.start.v) > least);
    BOOST_TEST(objective(step("semi_implicit_euler", n).v) > least);
  }
}

BOOST_AUTO_TEST_CASE(every_method_flies_freely_and_exactly_also_over_a_shortened_last_step) {
  // No force at all: q = q0 + t v0 for any consistent method, so that a run of 10.3 steps shows
  // the lengths of all of them.
  const Problem p{{.dimension = 3, .node_mass = Eigen::Vector2d(1, 3)},
                  {0, Vec::LinSpaced(6, -1, 1), Vec::LinSpaced(6, 2, -3)}};
  const auto system = make_mass_spring(p.network);
  for (const Method& method : general_methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      const double t = 1.03;
      const Run r = run(method, *system, p.initial, t, options_of(method, 0.1, 1e-6));
      BOOST_TEST(r.summary.message == "");
      // Rounding of at most some hundred steps or stages.
      BOOST_TEST(distance(r.state.v, p.initial.v) < 1e-13);
      BOOST_TEST(distance(r.state.q, p.initial.q + t * p.initial.v) < 1e-13);
    }
  }
}

BOOST_AUTO_TEST_CASE(another_formula_and_a_size_off_by_a_thousandth_are_noticed) {
  BOOST_TEST(largest_distance("symplectic_euler", explicit_step) > 1e-3);
  BOOST_TEST(largest_distance("implicit_euler", semi_implicit_step) > 1e-5);
  const auto longer = [](const System& system, const State& s) {
    return verlet_step(system, s, 1.001 * h);
  };
  BOOST_TEST(largest_distance("verlet", longer) > 1e-5);
}

BOOST_AUTO_TEST_SUITE_END()
