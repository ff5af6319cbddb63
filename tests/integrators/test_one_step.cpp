// One step on nonlinear networks, against formulas and equations as they stand in the papers.
#include <array>
#include <functional>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/kick_drift.hpp"
#include "tests/integrators/tables.hpp"

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

// Five masses in each dimension, springs in tension and in compression, all alike or some stiff.
std::vector<Scene5> networks() {
  std::mt19937 random(5);
  std::vector<Scene5> list;
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.9, 1.2}) {
      const Problem p = random_network(random, dimension, 5, stretch);
      list.push_back({make_mass_spring(p.network), p.initial});
      list.push_back({make_mass_spring(with_split(p.network)), p.initial});
    }
  }
  return list;
}

MatrixXd dense_mass(const System& system) { return system.mass().asDiagonal(); }

Vec acceleration(const System& system, const Vec& q) {
  return dense_mass(system).inverse() * force_at(system, q);
}

State explicit_euler(const System& system, const State& s) {
  return {h, s.q + h * s.v, s.v + h * acceleration(system, s.q)};
}
State symplectic_euler(const System& system, const State& s) {
  const Vec v = s.v + h * acceleration(system, s.q);
  return {h, s.q + h * v, v};
}
State semi_implicit_euler(const System& system, const State& s) {
  const MatrixXd m = dense_mass(system);
  const MatrixXd a = m - h * h * dense(stiffness_at(system, s.q));
  const Vec v = a.fullPivLu().solve(m * s.v + h * force_at(system, s.q));
  return {h, s.q + h * v, v};
}
State rk4(const System& system, const State& s) {
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
}
State kicks_and_drifts(const Splitting& table, const System& system, State s) {
  const bool drifts_first = table.drifts.size() > table.kicks.size();
  for (std::size_t i = 0; i < std::max(table.kicks.size(), table.drifts.size()); ++i) {
    if (drifts_first) s.q += table.drifts[i] * h * s.v;
    if (i < table.kicks.size()) s.v += table.kicks[i] * h * acceleration(system, s.q);
    if (!drifts_first && i < table.drifts.size()) s.q += table.drifts[i] * h * s.v;
  }
  return {h, s.q, s.v};
}
// Linearly implicit steps of these parts of h, by a dense solve over all unknowns.
State linear_midpoint(const std::vector<double>& parts, const System& system, State s) {
  const System& stiff = split_of(system) ? *split_of(system)->stiff : system;
  for (const double part : parts) {
    const double size = part * h;
    const Vec x = s.q + size / 2 * s.v;
    const MatrixXd a =
        dense_mass(system) - size * size / 4 * dense(material_stiffness_at(stiff, x));
    s.v += size * a.fullPivLu().solve(force_at(system, x));
    s.q = x + size / 2 * s.v;
  }
  return {h, s.q, s.v};
}

// A diagonally implicit table, row by row; the step is y + h sum of b_i F(stage i).
struct Table {
  MatrixXd a;
  Vec b;
};
// By an iteration of the stages' equations that shrinks by (h w)^2 a_ii^2 < 0.3 a round.
State by_table(const Table& table, const System& system, const State& start) {
  const Index n = system.size(), stages = table.b.size();
  MatrixXd q_rate = MatrixXd::Zero(n, stages), v_rate = q_rate;
  for (int round = 0; round < 100; ++round) {
    for (Index i = 0; i < stages; ++i) {
      const Vec row = h * table.a.row(i).transpose();
      const Vec q = start.q + q_rate * row, v = start.v + v_rate * row;
      q_rate.col(i) = v;
      v_rate.col(i) = acceleration(system, q);
    }
  }
  return {h, start.q + h * q_rate * table.b, start.v + h * v_rate * table.b};
}

using Step = std::function<State(const System&, const State&)>;
struct Formula {
  std::string method;
  Step step;
  double most = rounding;  // off
};

std::vector<Formula> formulas() {
  const double p = 1 / (4 - std::cbrt(4));
  const double g = 1 - 1 / std::sqrt(2.0), w = std::sqrt(2.0) / 4;
  std::vector<Formula> list = {
      {"explicit_euler", explicit_euler},
      {"symplectic_euler", symplectic_euler},
      {"semi_implicit_euler", semi_implicit_euler},
      {"rk4", rk4},
      {"linear_midpoint", std::bind_front(linear_midpoint, std::vector<double>{1})},
      {"linear_midpoint4",
       std::bind_front(linear_midpoint, std::vector<double>{p, p, 1 - 4 * p, p, p}), 5 * rounding}};
  for (const auto& [name, table] : methods_with_tables<KickDrift>()) {
    list.push_back({name, std::bind_front(kicks_and_drifts, table),
                    static_cast<double>(table.kicks.size()) * rounding});
  }
  const Table euler{MatrixXd{{1.0}}, Vec{{1.0}}}, midpoint{MatrixXd{{0.5}}, Vec{{1.0}}},
      sdirk2{MatrixXd{{g, 0}, {1 - g, g}}, Vec{{1 - g, g}}},
      trbdf2{MatrixXd{{0, 0, 0}, {g, g, 0}, {w, w, g}}, Vec{{w, w, g}}};
  for (const auto& [name, table] :
       {std::pair("implicit_euler", euler), {"implicit_midpoint", midpoint}, {"trbdf2", trbdf2}}) {
    // Solved to rounding, of q of 5 m over h.
    list.push_back({name, std::bind_front(by_table, table), 1e-12});
  }
  for (const auto& [name, table] : {std::pair("arkode_implicit_euler", euler),
                                    {"arkode_implicit_midpoint", midpoint},
                                    {"arkode_sdirk2", sdirk2},
                                    {"arkode_trbdf2", trbdf2}}) {
    // A tenth of Newton's 1e-10, of stages of some metres.
    list.push_back({name, std::bind_front(by_table, table), 2e-10});
  }
  return list;
}

// The method's own step.
State step(const std::string& method, const Scene5& n) {
  const Run r =
      run(method_named(method), *n.system, n.start, h, {.step_size = h, .solve_tolerance = 1e-13});
  BOOST_REQUIRE(r.summary.message == "");
  return r.state;
}

// Residuals of a step, by the equations of methods that have no formula.
struct Ends {
  const System& system;
  State a, b;
  // Of v' = v + h mean, q' = q + h (v + v')/2.
  double residual(const Vec& mean) const {
    return std::max(distance(b.v, a.v + h * mean), distance(b.q, a.q + h / 2 * (a.v + b.v)));
  }
};
double trapezoidal(const Ends& e) {
  return e.residual((acceleration(e.system, e.a.q) + acceleration(e.system, e.b.q)) / 2);
}
double discrete_gradient(const Ends& e) {
  Vec f(e.system.size());
  offered<DiscreteGradient>(e.system).discrete_gradient(e.a.q, e.b.q, f);
  return e.residual(f.cwiseQuotient(e.system.mass()));
}
// The method begins with a_n = M^-1 f(q_n).
double generalized_alpha(const Ends& e) {
  const double rho = 0.8, m = (2 * rho - 1) / (rho + 1), f = rho / (rho + 1);
  const double gamma = 0.5 - m + f, beta = std::pow(1 - m + f, 2) / 4;
  const Vec a0 = acceleration(e.system, e.a.q);
  const Vec a1 = (acceleration(e.system, (1 - f) * e.b.q + f * e.a.q) - m * a0) / (1 - m);
  return std::max(distance(e.b.v, e.a.v + h * ((1 - gamma) * a0 + gamma * a1)),
                  distance(e.b.q, e.a.q + h * e.a.v + h * h * ((0.5 - beta) * a0 + beta * a1)));
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_is_the_formula_of_its_method) {
  const std::vector<Scene5> all = networks();
  for (const auto& [method, formula, most] : formulas()) {
    double largest = 0;
    for (const Scene5& n : all) {
      largest = std::max(largest, distance(step(method, n), formula(*n.system, n.start)));
    }
    BOOST_TEST(largest < most, method << ": " << largest);
  }
}

BOOST_AUTO_TEST_CASE(a_step_solves_the_method_s_equations_and_no_others) {
  const std::array<std::pair<const char*, double (*)(const Ends&)>, 3> equations = {
      {{"trapezoidal", trapezoidal},
       {"discrete_gradient", discrete_gradient},
       {"generalized_alpha", generalized_alpha}}};
  for (const Scene5& n : networks()) {
    for (const auto& [method, residual] : equations) {
      const State end = step(method, n);
      for (const auto& [other, its_residual] : equations) {
        BOOST_TEST_CONTEXT(method << " in the equations of " << other) {
          const double left = its_residual({*n.system, n.start, end});
          BOOST_TEST((method == other ? left < 1e-12 : left > 1e-7));
        }
      }
    }
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

BOOST_DATA_TEST_CASE(free_flight_is_exact_also_over_a_shortened_last_step, general_methods(),
                     method) {
  // No force at all: q = q0 + t v0 for any consistent method, so that a run of 10.3 steps shows
  // the lengths of all of them.
  const Problem p{{.dimension = 3, .node_mass = Eigen::Vector2d(1, 3)},
                  {0, Vec::LinSpaced(6, -1, 1), Vec::LinSpaced(6, 2, -3)}};
  const double t = 1.03;
  const Run r = run(method, p, t, options_of(method, 0.1, 1e-6));
  BOOST_TEST(r.summary.message == "");
  // Rounding of at most some hundred steps or stages.
  BOOST_TEST(distance(r.state.v, p.initial.v) < 1e-13);
  BOOST_TEST(distance(r.state.q, p.initial.q + t * p.initial.v) < 1e-13);
}

BOOST_AUTO_TEST_SUITE_END()
