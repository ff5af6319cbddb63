#include <complex>

#include <boost/test/unit_test.hpp>

#include "integrators/methods/tables.hpp"
#include "tests/integrators/motions.hpp"

BOOST_AUTO_TEST_SUITE(rosenbrock)

using namespace qddot;

namespace {

using Eigen::MatrixXd;

// A table in the coefficients of the form without transformation (Hairer and Wanner, Solving ODEs
// II, eq. IV.7.4): U = Gamma k, so that alpha = a Gamma, b = m Gamma, and Gamma^-1 = I/gamma - c.
struct Plain {
  MatrixXd alpha, beta;  // beta = alpha + Gamma
  Vec b, lower_b;
};

Plain plain(const RosenbrockTable& table) {
  const Index s = std::ssize(table.a);
  MatrixXd a = MatrixXd::Zero(s, s), c = a;
  for (Index i = 0; i < s; ++i) {
    for (Index j = 0; j < i; ++j) {
      a(i, j) = table.a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      c(i, j) = table.c[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  const MatrixXd gamma = (MatrixXd::Identity(s, s) / table.gamma - c).inverse();
  Vec lower_m = a.row(s - 1);
  Vec m = lower_m;
  m[s - 1] = 1;
  return {a * gamma, a * gamma + gamma, gamma.transpose() * m, gamma.transpose() * lower_m};
}

// The residuals of the conditions of order 1, 2, 3, 3, 4, 4, 4, 4 of autonomous systems (Table
// IV.7.1 there, with gamma among the beta).
std::vector<double> conditions(const Plain& p, const Vec& b) {
  const Vec ones = Vec::Ones(b.size());
  const Vec alpha = p.alpha * ones, beta = p.beta * ones;
  return {b.sum() - 1,
          b.dot(beta) - 1. / 2,
          b.dot(alpha.cwiseAbs2()) - 1. / 3,
          b.dot(p.beta * beta) - 1. / 6,
          b.dot(alpha.cwiseAbs2().cwiseProduct(alpha)) - 1. / 4,
          b.dot(alpha.cwiseProduct(p.alpha * beta)) - 1. / 8,
          b.dot(p.beta * alpha.cwiseAbs2()) - 1. / 12,
          b.dot(p.beta * (p.beta * beta)) - 1. / 24};
}

// R(z) = 1 + z b'(I - z beta)^-1 1.
double amplification(const Plain& p, std::complex<double> z) {
  const Index s = p.b.size();
  const Eigen::MatrixXcd matrix =
      Eigen::MatrixXcd::Identity(s, s) - z * p.beta.cast<std::complex<double>>();
  const Eigen::VectorXcd k = matrix.partialPivLu().solve(Eigen::VectorXcd::Ones(s));
  return std::abs(1.0 + z * p.b.cast<std::complex<double>>().cwiseProduct(k).sum());
}

// A step of the method in the form without transformation, with a dense 2n x 2n Jacobian.
State step(const System& system, const State& start, double h) {
  const Plain p = plain(registered::rodas4_table());
  const Index n = system.size(), s = p.b.size();
  MatrixXd j = MatrixXd::Zero(2 * n, 2 * n);
  j.topRightCorner(n, n).setIdentity();
  j.bottomLeftCorner(n, n) =
      system.mass().cwiseInverse().asDiagonal() * dense(stiffness_at(system, start.q));
  Vec y(2 * n);
  y << start.q, start.v;
  const MatrixXd gamma = p.beta - p.alpha;
  const auto stage_matrix = (MatrixXd::Identity(2 * n, 2 * n) - h * gamma(0, 0) * j).partialPivLu();
  MatrixXd k = MatrixXd::Zero(2 * n, s);
  for (Index i = 0; i < s; ++i) {
    const Vec at = y + k * p.alpha.row(i).transpose();
    Vec f(2 * n);
    f << at.tail(n), force_at(system, at.head(n)).cwiseQuotient(system.mass());
    Vec before = gamma.row(i).transpose();
    before[i] = 0;
    k.col(i) = stage_matrix.solve(h * f + h * j * (k * before));
  }
  y += k * p.b;
  return {start.t + h, y.head(n), y.tail(n)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_table_meets_the_conditions_of_order_4_and_the_embedded_one_of_order_3) {
  const Plain p = plain(registered::rodas4_table());
  for (const double left : conditions(p, p.b)) BOOST_TEST(std::abs(left) < 1e-14);
  const auto lower = conditions(p, p.lower_b);
  for (std::size_t i = 0; i < 4; ++i) BOOST_TEST(std::abs(lower[i]) < 1e-14);
  for (std::size_t i = 4; i < 8; ++i) BOOST_TEST(std::abs(lower[i]) > 1e-3);
  RosenbrockTable wrong = registered::rodas4_table();
  wrong.c[4][2] *= 1.0001;
  double worst = 0;
  for (const double left : conditions(plain(wrong), plain(wrong).b)) {
    worst = std::max(worst, std::abs(left));
  }
  BOOST_TEST(worst > 1e-6);
}

BOOST_AUTO_TEST_CASE(it_is_a_stable_and_damps_infinite_frequencies_at_once) {
  const Plain p = plain(registered::rodas4_table());
  // Stages of up to 34, which cancel.
  for (double y = 1e-3; y < 1e6; y *= 1.3) BOOST_TEST(amplification(p, {0, y}) < 1 + 1e-12);
  BOOST_TEST(amplification(p, {0, 1e6}) < 1e-4);
  BOOST_TEST(amplification(p, {-1e6, 0}) < 1e-4);
}

BOOST_AUTO_TEST_CASE(a_step_in_n_x_n_form_is_the_one_of_the_first_order_form) {
  for (const KnownMotion& c : {linear(), nonlinear()}) {
    for (const double h : {0.001, 0.004, 0.016}) {
      // The tolerance is so coarse that one step is taken.
      const Run r = run(method_named("rodas4"), *c.system, c.start, h, {.rtol = 1e3});
      BOOST_REQUIRE(r.summary.counts.steps == 1);
      // Stages of 34 times what they make together, on q and v of 5, and matrices of condition 100.
      BOOST_TEST(distance(r.state, step(*c.system, c.start, h)) < 1e-11);
      BOOST_TEST(distance(r.state, step(*c.system, c.start, 1.0001 * h)) > 1e-8);
    }
  }
}

BOOST_AUTO_TEST_CASE(each_attempt_factorises_once_and_solves_six_times) {
  for (const KnownMotion& c : {linear(), nonlinear()}) {
    const Counts k =
        run(method_named("rodas4"), *c.system, c.start, 1, {.rtol = 1e-5}).summary.counts;
    BOOST_TEST(k.steps > 10);
    BOOST_TEST(k.solves == 6 * (k.steps + k.rejected));
    // Two to begin; the first stage has the acceleration of the last step's end.
    BOOST_TEST(k.force_evaluations == 2 + 5 * (k.steps + k.rejected) + k.steps);
    const bool is_linear = c.system->stiffness_is_constant();
    BOOST_TEST(k.stiffness_evaluations == (is_linear ? 1 : k.steps));
    BOOST_TEST(k.factorizations <= k.steps + k.rejected);
    if (!is_linear) BOOST_TEST(k.factorizations == k.steps + k.rejected);
    BOOST_TEST(k.newton_iterations == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
