#include <boost/test/unit_test.hpp>

#include "qddot/analysis/linear_motion.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(linear_motion)

using namespace qddot;

namespace {

// The motion from one start.
struct MotionFrom {
  MotionFrom(const System& system, State state) : motion(system), start(std::move(state)) {}
  State at(double t) const { return motion.after(start, t - start.t); }

  LinearMotion motion;
  State start;
};

// A random network whose springs have all lost rest length and quartic term.
Problem linear_network(int dimension, int nodes) {
  std::mt19937 random(6);
  const Problem p = random_network(random, dimension, nodes, 1);
  return {without_rest_lengths(p.network), p.initial};
}

// |v' - M^-1 f(q)| and |q' - v|, by differences in time.
double equation_error(const MotionFrom& motion, const System& system, double t) {
  const auto path = [&](const Vec& time) {
    const State state = motion.at(time[0]);
    Vec both(2 * system.size());
    both << state.q, state.v;
    return both;
  };
  const State now = motion.at(t);
  Vec expected(2 * system.size());
  expected << now.v, force_at(system, now.q).cwiseQuotient(system.mass());
  return distance(finite_difference_jacobian(path, Vec::Constant(1, t), 3e-4), expected);
}
// Amplitudes of up to 10 m and frequencies w <= 40 rad/s give a truncation of h^4 w^6 10 m / 30 =
// 1e-5 in v'. Rounding is far below it.
constexpr double difference_error = 1e-5;

// V = 1/2 4 (x - 1)^2 - 1/2 9 y^2 in turned axes x and y: a valley along x, a hill along y.
class Saddle final : public System {
 public:
  Saddle() : System(Vec::Constant(2, 2.0)) {
    Eigen::Matrix2d axes;
    axes << 0.6, -0.8, 0.8, 0.6;
    const Eigen::MatrixXd k = axes * Eigen::Vector2d(-4, 9).asDiagonal() * axes.transpose();
    k_ = Eigen::MatrixXd(k.triangularView<Eigen::Lower>()).sparseView();
    lowest_ = axes.col(0);
  }
  double potential(const At& at) const override {
    const Vec x = at.q - lowest_;
    return -0.5 * x.dot(k_.selfadjointView<Eigen::Lower>() * x);
  }
  void force(const At& at, MutableVec f) const override {
    f = k_.selfadjointView<Eigen::Lower>() * (at.q - lowest_);
  }
  const SymmetricMatrix& stiffness_pattern() const override { return k_; }
  void stiffness(const At&, SymmetricMatrix& k) const override { k = k_; }
  bool stiffness_is_constant() const override { return true; }

 private:
  SymmetricMatrix k_{2, 2};
  Vec lowest_;
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_mode_along_which_the_potential_falls_grows_exponentially) {
  const Saddle saddle;
  const double s = std::sqrt(4.5), w = std::sqrt(2.0);  // with masses of 2 kg
  const Vec valley = (Vec(2) << 0.6, 0.8).finished(), hill = (Vec(2) << -0.8, 0.6).finished();
  const Vec q0 = 1.5 * valley + 0.1 * hill, v0 = 0.3 * valley - 0.2 * hill;
  const MotionFrom motion(saddle, {0, q0, v0});
  for (const double t : {0.0, 0.01, 1.0, 5.0}) {
    const State state = motion.at(t);
    const Vec q = (1 + 0.5 * std::cos(w * t) + 0.3 / w * std::sin(w * t)) * valley +
                  (0.1 * std::cosh(s * t) - 0.2 / s * std::sinh(s * t)) * hill;
    const Vec v = (0.3 * std::cos(w * t) - 0.5 * w * std::sin(w * t)) * valley +
                  (0.1 * s * std::sinh(s * t) - 0.2 * std::cosh(s * t)) * hill;
    // Roundings of s and of the start grow by exp(st), and by st.
    const double tolerance = 16 * eps * (1 + s * t) * std::exp(s * t);
    BOOST_TEST((state.q - q).norm() < tolerance);
    BOOST_TEST((state.v - v).norm() < tolerance * (1 + s));
  }
}

BOOST_AUTO_TEST_CASE(oscillator_follows_its_closed_form_for_a_thousand_periods) {
  const Oscillator o;
  const auto [network, initial] = o.problem();
  const auto system = make_mass_spring(network);
  const MotionFrom motion(*system, initial);
  const double amplitude = std::hypot(o.x0, o.v0 / o.omega());
  for (const double periods : {0.0, 0.1, 0.5, 1.0, 10.3, 1000.7}) {
    const double t = periods * o.period();
    const State state = motion.at(t);
    // The phase w t is rounded in both formulas, and shifts q by amplitude times that.
    const double tolerance = 8 * eps * (1 + o.omega() * t) * amplitude;
    BOOST_TEST(state.t == t);
    BOOST_TEST(std::abs(state.q[0] - o.position(t)) < tolerance);
    BOOST_TEST(std::abs(state.v[0] - o.velocity(t)) < tolerance * o.omega());
  }
}

BOOST_AUTO_TEST_CASE(motion_starts_where_and_when_the_state_says) {
  for (const int dimension : {1, 2, 3}) {
    Problem p = linear_network(dimension, 6);
    const auto system = make_mass_spring(p.network);
    const State early = MotionFrom(*system, p.initial).at(2);
    p.initial.t = 40;
    const MotionFrom motion(*system, p.initial);
    // q comes back exactly, v through U U' = I.
    BOOST_TEST(distance(motion.at(40).q, p.initial.q) == 0);
    BOOST_TEST(distance(motion.at(40).v, p.initial.v) < 50 * eps * 2);
    BOOST_TEST(motion.at(42).t == 42);
    BOOST_TEST(distance(motion.at(42).q, early.q) == 0);
  }
}

BOOST_AUTO_TEST_CASE(motion_satisfies_the_equation_of_motion) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = linear_network(dimension, 6);
    const auto system = make_mass_spring(p.network);
    const MotionFrom motion(*system, p.initial);
    const double energy = total_energy(*system, p.initial);
    for (const double t : {0.0, 0.7, 13.0, 1000.0}) {
      BOOST_TEST(equation_error(motion, *system, t) < difference_error);
      // Each mode conserves its own energy whatever its phase: time does not enter. Up to 18 modes
      // are put together, and V is a sum of as many terms.
      BOOST_TEST(std::abs(total_energy(*system, motion.at(t)) - energy) <
                 100 * eps * (std::abs(energy) + system->kinetic(p.initial.v)));
    }
  }
}

BOOST_AUTO_TEST_CASE(free_masses_fly_on_parabolas) {
  const Network network = {
      .dimension = 3, .gravity = {1, 0, -9.81}, .node_mass = Vec{{0.3, 20}}, .links = {{0, 1, {}}}};
  const State start = {1, Vec::LinSpaced(6, -1, 3), Vec::LinSpaced(6, 5, -4)};
  const auto system = make_mass_spring(network);
  const Vec g = Vec{{1, 0, -9.81}}.replicate(2, 1);
  const MotionFrom motion(*system, start);
  for (const double t : {1.0, 1.5, 101.0}) {
    const double dt = t - 1;
    const Vec q = start.q + dt * start.v + 0.5 * dt * dt * g, v = start.v + dt * g;
    BOOST_TEST(distance(motion.at(t).q, q) <= 8 * eps * (3 + 5 * dt + 5 * dt * dt));
    BOOST_TEST(distance(motion.at(t).v, v) <= 8 * eps * (5 + 10 * dt));
  }
}

BOOST_AUTO_TEST_CASE(free_pair_drifts_with_its_centre_of_mass) {
  // w^2 = 0 comes out of the eigenproblem as some eps of the largest, whatever its sign.
  const Network network = {
      .dimension = 1, .gravity = {2, 0, 0}, .node_mass = Vec{{1, 3}}, .links = {{0, 1, {75}}}};
  const State start = {0, Vec{{-1, 2}}, Vec{{4, -2}}};
  const auto system = make_mass_spring(network);
  const MotionFrom motion(*system, start);
  for (const double t : {0.1, 1.0, 30.0}) {
    const State state = motion.at(t);
    // Centre (m1 x1 + m2 x2) / (m1 + m2), relative coordinate with w^2 = k (1/m1 + 1/m2) = 100.
    // An error of 3 eps 100 in w^2 = 0 bends the parabola by t^2 times that.
    const double centre = 1.25 - 0.5 * t + t * t;
    const double apart = 3 * std::cos(10 * t) - 0.6 * std::sin(10 * t);
    const double tolerance = 1e3 * eps * (1 + t * t) * (1 + t * t);
    BOOST_TEST(std::abs((state.q[0] + 3 * state.q[1]) / 4 - centre) < tolerance);
    BOOST_TEST(std::abs(state.q[1] - state.q[0] - apart) < tolerance);
  }
}

BOOST_AUTO_TEST_CASE(row_of_masses_has_the_frequencies_of_the_discrete_string) {
  const int n = 7;
  const double k = 300, amplitude = 0.2;
  const auto system = make_mass_spring(linear_chain(n, 1, k));
  const Vec place = Vec::LinSpaced(n, 1, n);  // at rest
  for (int j = 1; j <= n; ++j) {
    const double omega = 2 * std::sqrt(k) * std::sin(j * M_PI / (2 * (n + 1)));
    const Vec mode = (place * (j * M_PI / (n + 1))).array().sin();
    const MotionFrom motion(*system, {0, place + amplitude * mode, Vec::Zero(n)});
    for (const double periods : {0.25, 1.0, 20.4}) {
      const double t = periods * 2 * M_PI / omega;
      // w^2 is off by a few eps of the largest, 4 k: the phase by that times t / 2 w. The other
      // modes stay within the rounding of q, which gravity's absence leaves at n eps.
      const double tolerance = 10 * eps * (n + amplitude * 4 * k * t / omega);
      BOOST_TEST(distance(motion.at(t).q, place + amplitude * std::cos(omega * t) * mode) <
                 tolerance);
    }
  }
}

BOOST_AUTO_TEST_CASE(refuses_a_changing_stiffness_and_massless_nodes) {
  const Problem nonlinear = hammock(2);
  BOOST_CHECK_THROW(LinearMotion(*make_mass_spring(nonlinear.network)), std::invalid_argument);
  Problem massless = linear_network(2, 3);
  massless.network.node_mass[1] = 0;
  BOOST_CHECK_THROW(LinearMotion(*make_mass_spring(massless.network)), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(no_unknowns_have_a_motion_too) {
  const auto system = make_mass_spring({.dimension = 2});
  const State state = MotionFrom(*system, {1, Vec(), Vec()}).at(3);
  BOOST_TEST(state.t == 3);
  BOOST_TEST(state.q.size() == 0);
  BOOST_TEST(state.v.size() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
