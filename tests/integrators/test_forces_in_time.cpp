#include <cmath>
#include <memory>

#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "qddot/model/block_diagonal_system.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(forces_in_time)

using namespace qddot;
namespace data = boost::unit_test::data;

namespace {

constexpr double k = 1.7, push = 0.8, W = 1.9, until = 5;

// A mass of 1 kg with f = -k x - c v + a cos(W t), or without some of these terms. The spring is
// the stiff part, the rest the soft one.
class Driven final : public System,
                     public SplitStiffness,
                     public DiscreteGradient,
                     public Laplacian {
 public:
  Driven(double stiffness, double damping, double amplitude, bool has_split = true)
      : System(Vec::Ones(1)), k_(stiffness), c_(damping), a_(amplitude), pattern_(1, 1) {
    pattern_.insert(0, 0) = 0;
    pattern_.makeCompressed();
    if (!has_split) return;
    const auto spring = std::make_shared<Driven>(stiffness, 0, 0, false);
    split_ = {spring, std::make_shared<Driven>(0, damping, amplitude, false), spring, {0}};
  }

  double potential(const At& at) const override {
    return 0.5 * k_ * at.q[0] * at.q[0] - (a_ == 0 ? 0 : a_ * std::cos(W * at.t) * at.q[0]);
  }
  void force(const At& at, MutableVec f) const override {
    f[0] = -k_ * at.q[0];
    if (c_ != 0) f[0] -= c_ * at.v[0];
    if (a_ != 0) f[0] += a_ * std::cos(W * at.t);
  }
  bool is_conservative() const override { return c_ == 0; }
  bool is_autonomous() const override { return a_ == 0; }
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const At&, SymmetricMatrix& matrix) const override { matrix.coeffs()[0] = -k_; }
  bool stiffness_is_constant() const override { return true; }

  const SplitStiffness* split_stiffness() const override { return this; }
  void material_stiffness(const At& at, SymmetricMatrix& matrix) const override {
    stiffness(at, matrix);
  }
  void weighted_stiffness(const At& at, double, SymmetricMatrix& matrix) const override {
    stiffness(at, matrix);
  }
  const DiscreteGradient* discrete_gradient() const override { return this; }
  void mean_force(const At& a, const At& b, MutableVec f) const override {
    f[0] = -k_ * (a.q[0] + b.q[0]) / 2;
  }
  const Laplacian* laplacian() const override { return this; }
  void assemble_laplacian(SymmetricMatrix& l) const override { l.coeffs()[0] = k_; }
  bool bounds_stiffness() const override { return true; }
  const Split* split() const override { return split_.stiff ? &split_ : nullptr; }

 private:
  double k_, c_, a_;
  SymmetricMatrix pattern_;
  Split split_;
};

// The motion from x = 1 at rest: that of the driving frequency, and what is missing at the start.
State exact(double c, double a, double t) {
  // x = Re(z e^{iWt}) solves the equation for z = a/(k - W^2 + i c W).
  const std::complex<double> i(0, 1), z = a / std::complex<double>(k - W * W, c * W);
  const std::complex<double> turned = z * std::exp(i * W * t);
  const double w = std::sqrt(k - c * c / 4), x0 = 1 - z.real(), v0 = -(i * W * z).real();
  const double s = (v0 + c / 2 * x0) / w, e = std::exp(-c / 2 * t);
  const double x = e * (x0 * std::cos(w * t) + s * std::sin(w * t));
  const double v = -c / 2 * x + e * w * (-x0 * std::sin(w * t) + s * std::cos(w * t));
  return {t, Vec{{x + turned.real()}}, Vec{{v + (i * W * turned).real()}}};
}

double error_of(const Method& method, const System& system, double c, double a, double value) {
  State state = exact(c, a, 0);
  Options options;
  (method.knob == Knob::step_size ? options.step_size : options.rtol) = value;
  if (method.listens_to(Option::solve_tolerance)) options.solve_tolerance = 1e-12;
  if (method.listens_to(Option::iterations)) options.iterations = 100;
  const auto integrator = make_integrator(method, system, options);
  const Summary summary = integrator->advance(state, until);
  BOOST_TEST_REQUIRE((summary.outcome == Outcome::reached_end), summary.message);
  BOOST_TEST(summary.energy_growth == 1);  // nobody takes the energy for a constant
  const State there = exact(c, a, until);
  return std::max(std::abs(state.q[0] - there.q[0]), std::abs(state.v[0] - there.v[0]));
}

// The order that errors at two step sizes show; that of the method if they are rounding.
double observed_order(const Method& method, const System& system, double c, double a) {
  const double h = method.order > 6 ? until / 24 : method.order > 2 ? until / 80 : until / 1000;
  const double coarse = error_of(method, system, c, a, h);
  const double fine = error_of(method, system, c, a, h / 2);
  return fine < 1e-12 ? method.order : std::log2(coarse / fine);
}

void check(const Method& method, double c, double a) {
  const Driven system(k, c, a);
  if (method.knob == Knob::rtol) {
    // A hundred steps or more, each within its tolerance.
    BOOST_TEST(error_of(method, system, c, a, 1e-7) < 1e-4);
    return;
  }
  // h is small enough that the next term of the error changes the order by less.
  BOOST_TEST(observed_order(method, system, c, a) > method.order - 0.25);
}

void check_refusal(const Method& method, const System& system, Outcome outcome) {
  State state = exact(0, 0, 0);
  state.q.conservativeResize(system.size());
  state.v.conservativeResize(system.size());
  state.q.setOnes();
  state.v.setZero();
  const State before = state;
  Options options;
  (method.knob == Knob::step_size ? options.step_size : options.rtol) = 1e-3;
  const Summary summary = make_integrator(method, system, options)->advance(state, until);
  BOOST_TEST((summary.outcome == outcome), name(summary.outcome));
  BOOST_TEST(summary.message == advice(outcome));
  BOOST_TEST((summary.counts == Counts{}));
  BOOST_TEST((state.t == 0 && state.q == before.q));
}

}  // namespace

BOOST_DATA_TEST_CASE(methods_keep_their_order_with_forces_that_depend_on_time,
                     unconstrained_methods(), method) {
  // This system has forces of time without Driving.
  const bool needs_driving = method.asks(Need::rate_in_time) ||
                             method.asks(Need::balance_in_time) || method.asks(Need::known_in_time);
  if (method.asks(Need::autonomous) || needs_driving) {
    check_refusal(method, Driven(k, 0, push), Outcome::not_autonomous);
  } else {
    check(method, 0, push);
  }
}

BOOST_DATA_TEST_CASE(methods_keep_their_order_with_forces_that_depend_on_velocities,
                     unconstrained_methods(), method) {
  if (method.asks(Need::conservative)) {
    check_refusal(method, Driven(k, 0.6, 0), Outcome::not_conservative);
  } else {
    check(method, 0.6, 0);
    check(method, 0.6, push);
  }
}

BOOST_AUTO_TEST_CASE(a_time_that_stands_still_in_a_step_shows_in_the_order) {
  constexpr double h = until / 80;
  // The force at the start of each step of h or h/2.
  class Frozen final : public System {
   public:
    Frozen(const System& system, double h) : System(system.mass()), system_(system), h_(h) {}
    double potential(const At& at) const override { return system_.potential(at); }
    void force(const At& at, MutableVec f) const override {
      // A hundredth of a step before its end, time is that of its start.
      system_.force({h_ * std::floor(at.t / h_ - 0.01), at.q, at.v}, f);
    }
    bool is_autonomous() const override { return false; }

   private:
    const System& system_;
    double h_;
  };
  const Driven system(k, 0, push);
  const Method& method = method_named("rk4");
  const double coarse = error_of(method, Frozen(system, h), 0, push, h);
  const double fine = error_of(method, Frozen(system, h / 2), 0, push, h / 2);
  BOOST_TEST(std::log2(coarse / fine) < 1.25);
}

BOOST_AUTO_TEST_CASE(one_block_that_is_driven_or_damped_makes_the_whole_so) {
  for (const auto& [c, a] : {std::pair(0.0, 0.0), {0.6, 0.0}, {0.0, push}}) {
    std::vector<std::unique_ptr<System>> blocks;
    blocks.push_back(std::make_unique<Driven>(k, 0, 0));
    blocks.push_back(std::make_unique<Driven>(k, c, a));
    const BlockDiagonalSystem system(std::move(blocks));
    BOOST_TEST(system.is_conservative() == (c == 0));
    BOOST_TEST(system.is_autonomous() == (a == 0));
    State state{0, Vec::Ones(2), Vec::Zero(2)};
    const Summary summary =
        make_integrator(method_named("rk4"), system, {.step_size = 1e-3})->advance(state, until);
    BOOST_TEST_REQUIRE((summary.outcome == Outcome::reached_end));
    BOOST_TEST(std::abs(state.q[0] - exact(0, 0, until).q[0]) < 1e-9);  // h^4
    BOOST_TEST(std::abs(state.q[1] - exact(c, a, until).q[0]) < 1e-9);
    // Both functions of the whole see t and the block's own velocities.
    const Vec q{{1, 2}}, v{{3, 4}};
    Vec f(2);
    system.force({0.5, q, v}, f);
    BOOST_TEST(f[1] == -k * 2 - (c == 0 ? 0 : c * 4) + (a == 0 ? 0 : a * std::cos(W * 0.5)));
    if (c != 0) check_refusal(method_named("verlet"), system, Outcome::not_conservative);
    if (a != 0) check_refusal(method_named("exact"), system, Outcome::not_autonomous);
  }
}

BOOST_AUTO_TEST_SUITE_END()
