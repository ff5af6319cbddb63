#include <complex>
#include <functional>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(implicit_matrices)

using namespace qddot;

namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXd;

// x'' = -w^2 x with h = 1: its state (x, h v) or more, and the matrix that a step multiplies it by.
using Amplification = std::function<MatrixXd(double hw)>;

// The step of a method that is a rational function of z = h J, J = [[0, 1], [-(h w)^2, 0]].
Amplification rational(const std::function<MatrixXd(const MatrixXd& z)>& r) {
  return [r](double hw) { return r(MatrixXd{{0, 1}, {-hw * hw, 0}}); };
}
const MatrixXd one = MatrixXd::Identity(2, 2);

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

const double g = 2 - std::sqrt(2.0);

struct Formula {
  const char* method;
  Amplification matrix;
};
// Formulas of one-step methods; an acceleration, if there is one, is carried along as a third
// number.
const Formula formulas[] = {
    {"implicit_euler", rational([](const MatrixXd& z) { return (one - z).inverse(); })},
    {"implicit_midpoint",
     rational([](const MatrixXd& z) { return (one - z / 2).inverse() * (one + z / 2); })},
    {"trapezoidal",
     rational([](const MatrixXd& z) { return (one - z / 2).inverse() * (one + z / 2); })},
    {"discrete_gradient",
     rational([](const MatrixXd& z) { return (one - z / 2).inverse() * (one + z / 2); })},
    {"generalized_alpha", [](double hw) { return chung_hulbert(hw, 0.8); }},
    {"hht", [](double hw) { return hilber_hughes_taylor(hw, 0.8); }},
    {"trbdf2", rational([](const MatrixXd& z) {
       const MatrixXd middle = (one - g / 2 * z).inverse() * (one + g / 2 * z);
       return MatrixXd((one - (1 - g) / (2 - g) * z).inverse() *
                       (middle - (1 - g) * (1 - g) * one) / (g * (2 - g)));
     })}};

const Oscillator oscillator;
const double w = oscillator.omega();

// (x, h v), scaled so that both are of a size.
Vec scaled(const State& s, double h) { return Vec{{s.q[0], h * s.v[0]}}; }

State run_oscillator(const char* method, double h, double t_end) {
  const Problem p = oscillator.problem();
  const auto system = make_mass_spring(p.network);
  const Run r = run(method_named(method), *system, p.initial, t_end, {.step_size = h});
  BOOST_REQUIRE(r.summary.message == "");
  return r.state;
}

// The difference between the method and the power of its matrix after some steps, relative to the
// start.
double defect(const char* method, const Amplification& matrix, double hw, int steps) {
  const double h = hw / w;
  const MatrixXd a = matrix(hw);
  Vec y = scaled(oscillator.problem().initial, h);
  if (a.rows() == 3) {  // h^2 a
    y.conservativeResize(3);
    y[2] = -hw * hw * y[0];
  }
  const double start = y.head<2>().norm();
  for (int i = 0; i < steps; ++i) y = a * y;
  return distance(scaled(run_oscillator(method, h, steps * h), h), y.head<2>()) / start;
}

// Rounding of up to 100 steps; at h w = 100 a step cancels hw^2 times what it leaves.
double rounding(double hw) { return 1e-13 * (1 + hw * hw); }

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
  for (const auto& [method, matrix] : formulas) {
    for (const double hw : {0.01, 0.3, 1.0, 5.0, 100.0}) {
      for (const int steps : {1, 100}) {
        BOOST_TEST_CONTEXT(method << " at h w = " << hw << ", " << steps << " steps") {
          BOOST_TEST(defect(method, matrix, hw, steps) < rounding(hw));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(another_step_or_another_matrix_is_noticed) {
  for (const auto& [method, matrix] : formulas) {
    const Amplification longer = [&matrix = matrix](double hw) { return matrix(1.0001 * hw); };
    BOOST_TEST(defect(method, longer, 0.3, 10) > 100 * rounding(0.3));
  }
  BOOST_TEST(defect("hht", formulas[4].matrix, 0.3, 10) > 100 * rounding(0.3));
  BOOST_TEST(defect("trbdf2", formulas[1].matrix, 0.3, 10) > 100 * rounding(0.3));
}

BOOST_AUTO_TEST_CASE(bdf2_is_its_definition_also_over_a_shorter_last_step) {
  for (const double hw : {0.01, 0.3, 1.0, 5.0, 100.0}) {
    for (const double part : {1.0, 0.4}) {
      const double h = hw / w;
      const State end = run_oscillator("bdf2", h, (20 + part) * h);
      BOOST_TEST_CONTEXT("h w = " << hw << ", last " << part) {
        BOOST_TEST(distance(scaled(end, h), bdf2_by_hand(hw, 20, part)) < rounding(hw));
        if (hw <= 1) {  // beyond, nothing is left of the motion
          BOOST_TEST(distance(scaled(end, h), bdf2_by_hand(hw, 20, 0.9 * part)) >
                     10 * rounding(hw));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(no_matrix_grows_at_any_step_and_the_alphas_damp_as_asked) {
  for (const auto& [method, matrix] : formulas) {
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
  const Problem p = oscillator.problem();
  const auto system = make_mass_spring(p.network);
  const double hw = 2, h = hw / w;
  for (const char* method : {"generalized_alpha", "hht"}) {
    for (const double rho : {0.5, 0.7, 1.0}) {
      const Run r = run(method_named(method), *system, p.initial, 50 * h,
                        {.step_size = h, .spectral_radius = rho});
      const MatrixXd a =
          method == std::string("hht") ? hilber_hughes_taylor(hw, rho) : chung_hulbert(hw, rho);
      Vec y = scaled(p.initial, h);
      y.conservativeResize(3);
      y[2] = -hw * hw * y[0];
      for (int i = 0; i < 50; ++i) y = a * y;
      BOOST_TEST(distance(scaled(r.state, h), y.head<2>()) < rounding(hw));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
