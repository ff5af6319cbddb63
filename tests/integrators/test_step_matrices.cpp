// Steps on x'' = -w^2 x, against the matrix that each method multiplies its state by.
#include <functional>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/kick_drift.hpp"
#include "tests/integrators/tables.hpp"

BOOST_AUTO_TEST_SUITE(step_matrices)

using namespace qddot;

namespace {

using Eigen::MatrixXd;

// With h = 1: the state (x, h v) or more, and the matrix that a step multiplies it by.
using Amplification = std::function<MatrixXd(double hw)>;

// The step of a method that is a rational function of z = h J, J = [[0, 1], [-(h w)^2, 0]].
Amplification rational(const std::function<MatrixXd(const MatrixXd& z)>& r) {
  return [r](double hw) { return r(MatrixXd{{0, 1}, {-hw * hw, 0}}); };
}
const MatrixXd one = MatrixXd::Identity(2, 2);

MatrixXd splitting(const Splitting& table, double hw) {
  MatrixXd all = one;
  const auto apply = [&](const std::vector<double>& list, std::size_t i, Index row) {
    if (i >= list.size()) return;
    MatrixXd part = one;
    part(row, 1 - row) = row == 0 ? list[i] : -list[i] * hw * hw;
    all = part * all;
  };
  const bool drifts_first = table.drifts.size() > table.kicks.size();
  for (std::size_t i = 0; i < std::max(table.kicks.size(), table.drifts.size()); ++i) {
    if (drifts_first) apply(table.drifts, i, 0);
    apply(table.kicks, i, 1);
    if (!drifts_first) apply(table.drifts, i, 0);
  }
  return all;
}

// Unknowns (x', v', a') from (x, v, a), by the equations as they stand in the paper.
MatrixXd by_alphas(double hw, double alpha_m, double alpha_f) {
  const double gamma = 0.5 - alpha_m + alpha_f, beta = std::pow(1 - alpha_m + alpha_f, 2) / 4;
  const double w2 = hw * hw;
  const MatrixXd next{{1, 0, -beta}, {0, 1, -gamma}, {(1 - alpha_f) * w2, 0, 1 - alpha_m}};
  const MatrixXd last{{1, 1, 0.5 - beta}, {0, 1, 1 - gamma}, {-alpha_f * w2, 0, -alpha_m}};
  return next.inverse() * last;
}
MatrixXd chung_hulbert(double hw, double rho) {
  return by_alphas(hw, (2 * rho - 1) / (rho + 1), rho / (rho + 1));
}
MatrixXd hilber_hughes_taylor(double hw, double rho) {
  return by_alphas(hw, 0, (1 - rho) / (1 + rho));
}

MatrixXd backward_euler(const MatrixXd& z) { return (one - z).inverse(); }
MatrixXd midpoint(const MatrixXd& z) { return (one - z / 2).inverse() * (one + z / 2); }
// The trapezoidal rule to g h, then BDF2 on the three times 0, g h, h.
MatrixXd trbdf2(const MatrixXd& z) {
  const double g = 2 - std::sqrt(2.0);
  const MatrixXd middle = (one - g / 2 * z).inverse() * (one + g / 2 * z);
  return (one - (1 - g) / (2 - g) * z).inverse() * (middle - (1 - g) * (1 - g) * one) /
         (g * (2 - g));
}
MatrixXd alexander(const MatrixXd& z) {
  const double g = 1 - 1 / std::sqrt(2.0);
  const MatrixXd stage = (one - g * z).inverse();
  return stage * stage * (one + (1 - 2 * g) * z);
}
MatrixXd runge_kutta(const MatrixXd& z) {
  return one + z + z * z / 2 + z * z * z / 6 + z * z * z * z / 24;
}

struct Formula {
  std::string method;
  Amplification matrix;
};
// Formulas of one-step methods; an acceleration, if there is one, is carried along as a third
// number.
std::vector<Formula> formulas() {
  std::vector<Formula> list = {
      {"explicit_euler", rational([](const MatrixXd& z) { return one + z; })},
      {"symplectic_euler",
       [](double hw) {
         return splitting({1, {1}, {1}}, hw);
       }},
      {"semi_implicit_euler", rational(backward_euler)},
      {"rk4", rational(runge_kutta)},
      {"implicit_euler", rational(backward_euler)},
      {"implicit_midpoint", rational(midpoint)},
      {"trapezoidal", rational(midpoint)},
      {"discrete_gradient", rational(midpoint)},
      {"linear_midpoint", rational(midpoint)},
      {"generalized_alpha", [](double hw) { return chung_hulbert(hw, 0.8); }},
      {"hht", [](double hw) { return hilber_hughes_taylor(hw, 0.8); }},
      {"trbdf2", rational(trbdf2)},
      {"arkode_implicit_euler", rational(backward_euler)},
      {"arkode_implicit_midpoint", rational(midpoint)},
      {"arkode_sdirk2", rational(alexander)},
      {"arkode_trbdf2", rational(trbdf2)}};
  for (const auto& [name, table] : methods_with_tables<KickDrift>()) {
    list.push_back({name, [&table = table](double hw) { return splitting(table, hw); }});
  }
  return list;
}

const Oscillator oscillator;
const double w = oscillator.omega();

// (x, h v), scaled so that both are of a size.
Vec scaled(const State& s, double h) { return Vec{{s.q[0], h * s.v[0]}}; }

State run_oscillator(const std::string& method, double h, double t_end, double rho = 0.8) {
  const Run r = run(method_named(method), oscillator.problem(), t_end,
                    {.step_size = h, .spectral_radius = rho});
  BOOST_REQUIRE(r.summary.message == "");
  return r.state;
}

// The difference between the method and the power of its matrix after some steps, relative to the
// start, or to the end where the motion grows.
double defect(const Formula& formula, double hw, int steps, double rho = 0.8) {
  const double h = hw / w;
  const MatrixXd a = formula.matrix(hw);
  Vec y = scaled(oscillator.problem().initial, h);
  if (a.rows() == 3) {  // h^2 a
    y.conservativeResize(3);
    y[2] = -hw * hw * y[0];
  }
  double size = y.head<2>().norm();
  for (int i = 0; i < steps; ++i) y = a * y;
  size = std::max(size, y.head<2>().norm());
  return distance(scaled(run_oscillator(formula.method, h, steps * h, rho), h), y.head<2>()) / size;
}

// Rounding of up to 100 steps; at h w = 100 a step cancels hw^2 times what it leaves. The Newton
// iteration of ARKODE's methods leaves a tenth of 1e-10 in each.
double rounding(const Formula& formula, double hw, int steps = 100) {
  if (method_named(formula.method).family == Family::sundials) return 1e-10 * steps;
  return 1e-13 * (1 + hw * hw);
}

double spectral_radius(const MatrixXd& a) { return a.eigenvalues().cwiseAbs().maxCoeff(); }

// BDF2 from its definition, the first step one of implicit Euler and the last one shorter.
Vec bdf2_by_hand(double hw, int steps, double last_part) {
  const MatrixXd z{{0, 1}, {-hw * hw, 0}};
  Vec last = scaled(oscillator.problem().initial, hw / w);
  Vec now = (one - z).inverse() * last;
  for (int i = 1; i < steps; ++i) {
    const Vec next = (1.5 * one - z).inverse() * (2 * now - 0.5 * last);
    last = now;
    now = next;
  }
  // The derivative at the end of the parabola through times -1, 0 and p.
  const double p = last_part;
  const double c_next = (1 + 2 * p) / (p * (1 + p)), c_now = -(1 + p) / p, c_last = p / (1 + p);
  return (c_next * one - z).inverse() * (-c_now * now - c_last * last);
}

}  // namespace

BOOST_AUTO_TEST_CASE(steps_multiply_the_oscillator_by_the_method_s_own_matrix) {
  for (const Formula& formula : formulas()) {
    const bool is_implicit = method_named(formula.method).is(Trait::implicit);
    for (const double hw : {0.01, 0.3, 1.0, 5.0, 100.0}) {
      if (hw > 1 && !is_implicit) continue;
      for (const int steps : {1, 100}) {
        BOOST_TEST_CONTEXT(formula.method << " at h w = " << hw << ", " << steps << " steps") {
          BOOST_TEST(defect(formula, hw, steps) < rounding(formula, hw, steps));
        }
      }
    }
    const Formula longer{formula.method, [&](double hw) { return formula.matrix(1.0001 * hw); }};
    BOOST_TEST(defect(longer, 0.3, 1) > rounding(formula, 0.3, 1));  // noticed
  }
}

BOOST_AUTO_TEST_CASE(bdf2_is_its_definition_also_over_a_shorter_last_step) {
  for (const double hw : {0.01, 0.3, 1.0, 5.0, 100.0}) {
    for (const double part : {1.0, 0.4}) {
      const double h = hw / w;
      const State end = run_oscillator("bdf2", h, (20 + part) * h);
      BOOST_TEST_CONTEXT("h w = " << hw << ", last " << part) {
        BOOST_TEST(distance(scaled(end, h), bdf2_by_hand(hw, 20, part)) < 1e-13 * (1 + hw * hw));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(no_implicit_matrix_grows_at_any_step_and_the_alphas_damp_as_asked) {
  for (const auto& [method, matrix] : formulas()) {
    if (!method_named(method).is(Trait::implicit)) continue;
    for (double hw = 1e-2; hw < 1e4; hw *= 1.5) {
      BOOST_TEST_CONTEXT(method << " at h w = " << hw) {
        BOOST_TEST(spectral_radius(matrix(hw)) < 1 + 1e-9);
      }
    }
  }
  for (const double rho : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    // A double root where rho is the radius: rounding enters by its square root.
    BOOST_TEST(std::abs(spectral_radius(chung_hulbert(1e6, rho)) - rho) < 1e-3);
    if (rho >= 0.5) {
      BOOST_TEST(std::abs(spectral_radius(hilber_hughes_taylor(1e6, rho)) - rho) < 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_spectral_radius_asked_for_is_the_one_that_is_had) {
  for (const double rho : {0.5, 0.7, 1.0}) {
    for (const auto& [method, matrix] : {std::pair("generalized_alpha", &chung_hulbert),
                                         std::pair("hht", &hilber_hughes_taylor)}) {
      const Formula formula{method, [&, m = matrix](double hw) { return m(hw, rho); }};
      BOOST_TEST(defect(formula, 2, 50, rho) < rounding(formula, 2));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
