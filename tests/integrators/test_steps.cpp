// Steps against formulas and equations as they stand in the papers: one step on nonlinear networks,
// and up to a hundred of any length on x'' = -w^2 x.
#include <array>
#include <functional>

#include <boost/test/unit_test.hpp>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/integrators/base/kick_drift.hpp"
#include "tests/integrators/tables.hpp"

BOOST_AUTO_TEST_SUITE(steps)

using namespace qddot;

namespace {

using Eigen::MatrixXd;

constexpr double h = 0.01;  // s; h w is up to about 0.3 in these networks

// Rounding of one step. It has some 10 operations, each with a relative error of 1e-16. They are on
// q of 5 m, v of 5 m/s and h M^-1 f of 2 m/s. A dense solve multiplies it by a condition below 100.
constexpr double rounding = 1e-13;

// Five masses in each dimension, springs in tension and in compression, all alike or some stiff.
std::vector<Problem> networks() {
  std::mt19937 random(5);
  std::vector<Problem> list;
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.9, 1.2}) {
      const Problem p = random_network(random, dimension, 5, stretch);
      list.push_back(p);
      list.push_back({with_split(p.network), p.initial});
    }
  }
  return list;
}

MatrixXd dense_mass(const System& system) { return system.mass().asDiagonal(); }

Vec acceleration(const System& system, const Vec& q) {
  return force_at(system, q).cwiseQuotient(system.mass());
}

State semi_implicit_euler(const System& system, const State& s, double size) {
  const MatrixXd m = dense_mass(system);
  const MatrixXd a = m - size * size * dense(stiffness_at(system, s.q));
  const Vec v = solution(a, m * s.v + size * force_at(system, s.q));
  return {s.t + size, s.q + size * v, v};
}
State kicks_and_drifts(const Splitting& table, const System& system, State s, double size) {
  const bool drifts_first = table.drifts.size() > table.kicks.size();
  for (std::size_t i = 0; i < std::max(table.kicks.size(), table.drifts.size()); ++i) {
    if (drifts_first) s.q += table.drifts[i] * size * s.v;
    if (i < table.kicks.size()) s.v += table.kicks[i] * size * acceleration(system, s.q);
    if (!drifts_first && i < table.drifts.size()) s.q += table.drifts[i] * size * s.v;
  }
  return {s.t + size, s.q, s.v};
}
// Linearly implicit steps of these parts of a step, by a dense solve over all unknowns.
State linear_midpoint(const std::vector<double>& parts, const System& system, State s,
                      double whole) {
  const System& stiff = system.split() ? *system.split()->stiff : system;
  for (const double part : parts) {
    const double size = part * whole;
    const Vec x = s.q + size / 2 * s.v;
    const MatrixXd a =
        dense_mass(system) - size * size / 4 * dense(material_stiffness_at(stiff, x));
    s.v += size * solution(a, force_at(system, x));
    s.q = x + size / 2 * s.v;
  }
  return {s.t + whole, s.q, s.v};
}

// A Runge-Kutta table, explicit or diagonally implicit, row by row; the step is y + h sum of b_i
// F(stage i).
struct Table {
  MatrixXd a;
  Vec b;
};
State by_table(const Table& table, const System& system, const State& s, double size) {
  const Index n = s.q.size(), stages = table.b.size();
  const MatrixXd m = dense_mass(system);
  MatrixXd q_rate = MatrixXd::Zero(n, stages), v_rate = q_rate;
  for (Index i = 0; i < stages; ++i) {
    const Vec row = size * table.a.row(i).transpose();
    const Vec q = s.q + q_rate * row, known = s.v + v_rate * row;  // by the stages before
    // Newton's iteration on M (v - known) = c f(q + c v).
    const double c = row[i];
    Vec v = known;
    for (int round = 0; c != 0 && round < 20; ++round) {
      const MatrixXd matrix = m - c * c * dense(stiffness_at(system, q + c * v));
      v += solution(matrix, m * (known - v) + c * force_at(system, q + c * v));
    }
    q_rate.col(i) = v;
    v_rate.col(i) = acceleration(system, q + c * v);
  }
  return {s.t + size, s.q + size * q_rate * table.b, s.v + size * v_rate * table.b};
}

using Step = std::function<State(const System&, const State&, double size)>;
struct Expected {
  std::string method;
  Step step;
  double most = rounding;  // off
};

const Table midpoint{MatrixXd{{0.5}}, Vec{{1.0}}};

std::vector<Expected> expected_steps() {
  const double p = 1 / (4 - std::cbrt(4));
  const double g = 1 - 1 / std::sqrt(2.0), w = std::sqrt(2.0) / 4;
  const Table forward{MatrixXd{{0.0}}, Vec{{1.0}}}, backward{MatrixXd{{1.0}}, Vec{{1.0}}},
      rk4{MatrixXd{{0, 0, 0, 0}, {0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 1, 0}},
          Vec{{1 / 6., 1 / 3., 1 / 3., 1 / 6.}}},
      trapezoidal{MatrixXd{{0, 0}, {0.5, 0.5}}, Vec{{0.5, 0.5}}},
      sdirk2{MatrixXd{{g, 0}, {1 - g, g}}, Vec{{1 - g, g}}},
      trbdf2{MatrixXd{{0, 0, 0}, {g, g, 0}, {w, w, g}}, Vec{{w, w, g}}};
  std::vector<Expected> list = {
      {"symplectic_euler", std::bind_front(kicks_and_drifts, Splitting{1, {1}, {1}})},
      {"semi_implicit_euler", semi_implicit_euler},
      {"linear_midpoint", std::bind_front(linear_midpoint, std::vector<double>{1})},
      {"linear_midpoint4",
       std::bind_front(linear_midpoint, std::vector<double>{p, p, 1 - 4 * p, p, p}), 5 * rounding}};
  for (const auto& [name, table] : methods_with_tables(&Method::splitting)) {
    list.push_back({name, std::bind_front(kicks_and_drifts, table),
                    static_cast<double>(table.kicks.size()) * rounding});
  }
  // Implicit ones are solved to rounding, of q of 5 m over h, or to a tenth of Newton's 1e-10, of
  // stages of some metres.
  constexpr double solved = 1e-12, by_arkode = 2e-10;
  for (const auto& [name, table, most] : {std::tuple("explicit_euler", forward, rounding),
                                          {"rk4", rk4, rounding},
                                          {"implicit_euler", backward, solved},
                                          {"implicit_midpoint", midpoint, solved},
                                          {"trapezoidal", trapezoidal, solved},
                                          {"trbdf2", trbdf2, solved},
                                          {"arkode_implicit_euler", backward, by_arkode},
                                          {"arkode_implicit_midpoint", midpoint, by_arkode},
                                          {"arkode_sdirk2", sdirk2, by_arkode},
                                          {"arkode_trbdf2", trbdf2, by_arkode}}) {
    list.push_back({name, std::bind_front(by_table, table), most});
  }
  return list;
}

// The method's own step.
State step(const std::string& method, const Problem& p) {
  const Run r = run(method_named(method), p, h, {.step_size = h, .solve_tolerance = 1e-13});
  BOOST_REQUIRE(r.summary.message == "");
  return r.state;
}

// Residuals of a step, by the equations of methods that have no formula.
struct Ends {
  const System& system;
  State a, b;
};
// v' = v + h M^-1 mean, q' = q + h (v + v')/2.
double discrete_gradient(const Ends& e) {
  const Vec f = mean_force_between(e.system, e.a.q, e.b.q);
  return std::max(distance(e.b.v, e.a.v + h * f.cwiseQuotient(e.system.mass())),
                  distance(e.b.q, e.a.q + h / 2 * (e.a.v + e.b.v)));
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

const Oscillator oscillator;
constexpr double any_hw[] = {0.01, 0.3, 1.0, 5.0, 100.0};

// (x, h v), scaled so that both are of a size.
Vec scaled(const State& s, double size) { return Vec{{s.q[0], size * s.v[0]}}; }

// The scaled end of a run over the oscillator, in steps of hw/w.
Vec run_oscillator(const std::string& method, double hw, double steps, double rho = 0.8) {
  const double size = hw / oscillator.omega();
  const Run r = run(method_named(method), oscillator.problem(), steps * size,
                    {.step_size = size, .spectral_radius = rho});
  BOOST_REQUIRE(r.summary.message == "");
  return scaled(r.state, size);
}

// The difference between the method and its formula after some steps, relative to the start, or to
// the end where the motion grows.
double defect(const Expected& formula, double hw, int steps, double longer = 1) {
  const double size = hw / oscillator.omega();
  const auto system = make_mass_spring(oscillator.problem().network);
  State s = oscillator.problem().initial;
  const double start = scaled(s, size).norm();
  for (int i = 0; i < steps; ++i) s = formula.step(*system, s, longer * size);
  const Vec end = scaled(s, size);
  return distance(run_oscillator(formula.method, hw, steps), end) / std::max(start, end.norm());
}

// Rounding of up to 100 steps; at h w = 100 a step cancels hw^2 times what it leaves. The Newton
// iteration of ARKODE's methods leaves a tenth of 1e-10 in each.
double roundings(const std::string& method, double hw, int steps) {
  if (method_named(method).family == Family::sundials) return 1e-10 * steps;
  return 1e-13 * (1 + hw * hw);
}

// The matrix of a step from (x, h v, h^2 a), by the equations as they stand in the paper.
MatrixXd by_alphas(double hw, double alpha_m, double alpha_f) {
  const double gamma = 0.5 - alpha_m + alpha_f, beta = std::pow(1 - alpha_m + alpha_f, 2) / 4;
  const double w2 = hw * hw;
  const Eigen::Matrix3d next{{1, 0, -beta}, {0, 1, -gamma}, {(1 - alpha_f) * w2, 0, 1 - alpha_m}};
  const Eigen::Matrix3d last{{1, 1, 0.5 - beta}, {0, 1, 1 - gamma}, {-alpha_f * w2, 0, -alpha_m}};
  return next.inverse() * last;
}

// BDF2 from its definition, the first step one of implicit Euler and the last one shorter.
Vec bdf2_by_hand(double hw, int steps, double last_part) {
  const MatrixXd one = MatrixXd::Identity(2, 2), z{{0, 1}, {-hw * hw, 0}};
  Vec last = scaled(oscillator.problem().initial, hw / oscillator.omega());
  Vec now = solution(one - z, last);
  for (int i = 1; i < steps; ++i) {
    const Vec next = solution(1.5 * one - z, 2 * now - 0.5 * last);
    last = now;
    now = next;
  }
  // The derivative at the end of the parabola through times -1, 0 and p.
  const double p = last_part;
  const double c_next = (1 + 2 * p) / (p * (1 + p)), c_now = -(1 + p) / p, c_last = p / (1 + p);
  return solution(c_next * one - z, -c_now * now - c_last * last);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_is_the_formula_of_its_method) {
  const std::vector<Problem> all = networks();
  for (const auto& [method, formula, most] : expected_steps()) {
    double largest = 0;
    for (const Problem& p : all) {
      const State expected = formula(*make_mass_spring(p.network), p.initial, h);
      largest = std::max(largest, distance(step(method, p), expected));
    }
    BOOST_TEST(largest < most, method << ": " << largest);
  }
}

BOOST_AUTO_TEST_CASE(a_step_solves_the_method_s_equations_and_no_others) {
  const std::array<std::pair<const char*, double (*)(const Ends&)>, 2> equations = {
      {{"discrete_gradient", discrete_gradient}, {"generalized_alpha", generalized_alpha}}};
  for (const Problem& p : networks()) {
    const auto system = make_mass_spring(p.network);
    for (const auto& [method, residual] : equations) {
      const State end = step(method, p);
      for (const auto& [other, its_residual] : equations) {
        BOOST_TEST_CONTEXT(method << " in the equations of " << other) {
          const double left = its_residual({*system, p.initial, end});
          BOOST_TEST((method == other ? left < 1e-12 : left > 1e-7));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(steps_on_the_oscillator_are_those_of_the_formula_at_any_length) {
  std::vector<Expected> list = expected_steps();
  // The gradient of a parabola is that of its middle.
  list.push_back({"discrete_gradient", std::bind_front(by_table, midpoint)});
  for (const Expected& formula : list) {
    const std::string& method = formula.method;
    for (const double hw : any_hw) {
      if (hw > 1 && !method_named(method).is(Trait::implicit)) continue;
      for (const int steps : {1, 100}) {
        BOOST_TEST_CONTEXT(method << " at h w = " << hw << ", " << steps << " steps") {
          BOOST_TEST(defect(formula, hw, steps) < roundings(method, hw, steps));
        }
      }
    }
    BOOST_TEST(defect(formula, 0.3, 1, 1.0001) > roundings(method, 0.3, 1));  // noticed
  }
}

BOOST_AUTO_TEST_CASE(implicit_and_semi_implicit_euler_damp_by_their_factor_at_any_length) {
  for (const char* method : {"implicit_euler", "semi_implicit_euler"}) {
    for (const double hw : any_hw) {
      const auto amplitude = [&](int steps) {
        const Vec end = run_oscillator(method, hw, steps);
        return std::hypot(hw * end[0], end[1]);
      };
      const double factor = std::pow(amplitude(50) / amplitude(0), 1. / 50);
      // A step cancels all but 1/(h w) of the amplitude, and with it as many digits.
      BOOST_TEST(std::abs(factor * std::hypot(1, hw) - 1) < 1e-15 * (1 + hw));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_alphas_are_their_equations_with_the_spectral_radius_asked_for) {
  for (const double asked : {0.0, 0.3, 0.5, 0.7, 0.8, 1.0}) {
    const double least = std::max(asked, 0.5);  // of hht
    for (const auto& [method, rho, alpha_m, alpha_f] :
         {std::tuple("generalized_alpha", asked, (2 * asked - 1) / (asked + 1),
                     asked / (asked + 1)),
          {"hht", least, 0.0, (1 - least) / (1 + least)}}) {
      for (const double hw : any_hw) {
        for (const int steps : {1, 100}) {
          Vec y(3);
          y << scaled(oscillator.problem().initial, hw / oscillator.omega()), 0;
          y[2] = -hw * hw * y[0];
          const double start = y.head<2>().norm();
          for (int i = 0; i < steps; ++i) y = by_alphas(hw, alpha_m, alpha_f) * y;
          BOOST_TEST_CONTEXT(method << " of " << asked << " at h w = " << hw << ", " << steps) {
            BOOST_TEST(distance(run_oscillator(method, hw, steps, asked), y.head<2>()) <
                       roundings(method, hw, steps) * start);
          }
        }
      }
      // A double root where rho is the radius: rounding enters by its square root.
      const Eigen::VectorXcd roots = general_values(by_alphas(1e6, alpha_m, alpha_f));
      BOOST_TEST(std::abs(roots.cwiseAbs().maxCoeff() - rho) < 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(bdf2_is_its_definition_also_over_a_shorter_last_step) {
  for (const double hw : any_hw) {
    for (const double part : {1.0, 0.4}) {
      BOOST_TEST_CONTEXT("h w = " << hw << ", last " << part) {
        BOOST_TEST(distance(run_oscillator("bdf2", hw, 20 + part), bdf2_by_hand(hw, 20, part)) <
                   1e-13 * (1 + hw * hw));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
