// linear_midpoint and its composition linear_midpoint4, with a stiff set and where all springs are
// implicit: stability, and the limit of stiff springs.
#include <boost/test/unit_test.hpp>

#include "qddot/algebra/effective_mass.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(linear_midpoint)

using namespace qddot;

namespace {

using Eigen::Matrix2d;

struct Form {
  const char* name;
  std::vector<double> gamma;  // the steps that one step is made of, in parts of it
};
const std::vector<Form>& forms() {
  static const double p = 1 / (4 - std::cbrt(4));
  static const std::vector<Form> both = {{"linear_midpoint", {1}},
                                         {"linear_midpoint4", {p, p, 1 - 4 * p, p, p}}};
  return both;
}

// A step of h on q'' = -(w_f^2 + w_s^2) q in (q, v).
Matrix2d step_matrix(const Form& form, double h, double w_f, double w_s) {
  Matrix2d all = Matrix2d::Identity();
  for (const double g : form.gamma) {
    const double part = g * h;
    const double w2 = (w_f * w_f + w_s * w_s) / (1 + part * part * w_f * w_f / 4);
    const Matrix2d drift{{1, part / 2}, {0, 1}}, kick{{1, 0}, {-part * w2, 1}};
    all = drift * kick * drift * all;
  }
  return all;
}

// Its spectral radius; its determinant is 1.
double growth(const Form& form, double h, double w_f, double w_s) {
  const double t = std::abs(step_matrix(form, h, w_f, w_s).trace() / 2);
  return t > 1 ? t + std::sqrt(t * t - 1) : 1;
}

// A unit mass on a stiff and a soft spring of zero rest length.
Network two_springs(double w_f, double w_s) {
  Network network{.dimension = 1, .node_mass = Vec::Ones(1), .offers_split = true};
  network.anchors = {{0, {0, 0, 0}, {w_s * w_s}}};
  if (w_f > 0) network.anchors.push_back({0, {0, 0, 0}, {w_f * w_f}, Holds::always, true});
  return network;
}

// The growth of sqrt(w^2 q^2 + v^2) in a step, from the last half of `steps` steps.
double observed_growth(const Form& form, double h, double w_f, double w_s, int steps) {
  const auto system = make_mass_spring(two_springs(w_f, w_s));
  const auto amplitude = [&](int count) {
    const Run r = run(method_named(form.name), *system, {0, Vec::Ones(1), Vec::Ones(1)}, count * h,
                      {.step_size = h});
    BOOST_TEST(r.summary.message == "");
    return std::hypot(std::hypot(w_f, w_s) * r.state.q[0], r.state.v[0]);
  };
  return std::pow(amplitude(steps) / amplitude(steps / 2), 2.0 / steps);
}

// Checks that the form grows as the theory predicts, in steps of h at w_s = 1.
void check_growth(const Form& form, double h, double w_f) {
  const double expected = growth(form, h, w_f, 1);
  BOOST_TEST(expected > 1.03);
  // The growing mode is 1e26 times the other one after half of the steps.
  const int steps = 2 * static_cast<int>(std::ceil(30 / std::log(expected)));
  BOOST_TEST(std::abs(observed_growth(form, h, w_f, 1, steps) / expected - 1) < 1e-9);
}

// A unit mass on a spring of 1 m and k N/m that hangs from the origin of a plane, let go from the
// horizontal.
constexpr double gravity = 9.81;
Problem pendulum(double k) {
  Network network{.dimension = 2, .gravity = {0, -gravity, 0}, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {0, 0, 0}, {k, 1}}};
  return {network, {0, Vec{{1, 0}}, Vec::Zero(2)}};
}

// The same on a rod: a'' = g cos a, a the angle below the horizontal, by 1e5 steps of Verlet, whose
// error is some 1e-10.
State on_a_rod(double t_end) {
  constexpr int steps = 100000;
  const double h = t_end / steps;
  double angle = 0, rate = 0;
  for (int i = 0; i < steps; ++i) {
    rate += h / 2 * gravity * std::cos(angle);
    angle += h * rate;
    rate += h / 2 * gravity * std::cos(angle);
  }
  const Vec along{{std::cos(angle), -std::sin(angle)}},
      across{{-std::sin(angle), -std::cos(angle)}};
  return {t_end, along, rate * across};
}

}  // namespace

BOOST_AUTO_TEST_CASE(soft_springs_bound_the_step_and_stiff_ones_do_not) {
  const Form& plain = forms().front();
  for (const double w_f : {0.0, 1.0, 30.0, 1e3, 1e6}) {
    for (double h = 0.01; h < 2; h += 0.01) BOOST_TEST(growth(plain, h, w_f, 1) == 1);
    BOOST_TEST(growth(plain, 2.01, w_f, 1) > 1);
    // The amplitude swings where it is bounded: by (1 - h^2 w_s^2 / 4)^-1/2 = 7 here, in 1e4 steps.
    BOOST_TEST(observed_growth(plain, 1.98, w_f, 1, 20000) < 1.001);
  }
  for (const double w_f : {0.0, 1.0, 5.0}) check_growth(plain, 2.2, w_f);
}

BOOST_AUTO_TEST_CASE(five_steps_at_a_time_grow_in_narrow_bands) {
  const Form& five = forms().back();
  // They turn the vibration by a multiple of pi at h w_s = 1.75 and w_f = 5 w_s.
  check_growth(five, 1.75, 5);
  BOOST_TEST(observed_growth(five, 1.65, 5, 1, 20000) < 1.001);
  BOOST_TEST(growth(five, 1.65, 5, 1) == 1);
  // Bands grow narrower and slower with w_f, and none begins below h w_s = 0.9.
  for (const double w_f : {0.0, 1.0, 3.0, 10.0, 100.0, 1e4}) {
    for (double h = 0.01; h < 0.9; h += 0.001) {
      BOOST_TEST(growth(five, h, w_f, 1) < 1.001, "grows at h = " << h << " with w_f = " << w_f);
    }
  }
}

BOOST_AUTO_TEST_CASE(stiff_springs_become_rods) {
  const double t_end = 0.75;
  const State rod = on_a_rod(t_end);
  const double h = t_end / 64;
  const auto error = [&](const char* method, double k, double size) {
    const Run r = run(method_named(method), pendulum(k), t_end, {.step_size = size});
    BOOST_TEST(r.summary.message == "");
    return distance(r.state.q, rod.q);
  };
  // Both are of order 2 then.
  for (const Form& form : forms()) {
    std::vector<double> errors;
    for (int halving = 0; halving <= 4; ++halving) {
      errors.push_back(error(form.name, 1e14, std::ldexp(h, -halving)));
    }
    const double order = observed_order(errors);
    BOOST_TEST(std::abs(order - 2) < 0.1, form.name << " has order " << order);
  }
  // Rods are 3 m g / k longer at the lowest point, and vibrate by as much.
  const double limit = error("linear_midpoint", 1e14, h);
  for (const double k : {1e6, 1e8, 1e10, 1e12}) {
    const double e = error("linear_midpoint", k, h);
    BOOST_TEST(std::abs(e / limit - 1) < 0.2, "k = " << k << ": " << e << ", not " << limit);
  }
  BOOST_TEST(error("linear_midpoint4", 1e14, h) < limit / 2);
  // Negative control: what explicit methods make of it.
  const Run r = run(method_named("verlet"), pendulum(1e6), t_end, {.step_size = h});
  BOOST_TEST(name(r.summary.outcome) == "diverged");
}

BOOST_AUTO_TEST_CASE(compression_does_not_make_its_matrix_indefinite) {
  Network network{.dimension = 2, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {-0.5, 0, 0}, {1e5, 0.6}}, {0, {0.5, 0, 0}, {1e5, 0.6}}};
  const auto system = make_mass_spring(network);
  const State start{0, Vec{{0, 1e-6}}, Vec::Zero(2)};
  // Across the springs K is 2 k (0.6 - 0.5) / 0.5, forty thousand times the mass.
  const double h = 0.02;
  BOOST_TEST(
      !EffectiveMass(*system).factorize_positive(1, h * h / 4, stiffness_at(*system, start.q)));
  for (const Form& form : forms()) {
    BOOST_TEST(
        run(method_named(form.name), *system, start, 0.1, {.step_size = h}).summary.message == "");
  }
}

BOOST_AUTO_TEST_CASE(forces_are_those_of_the_whole_and_the_matrix_that_of_the_stiff_springs) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  for (const Form& form : forms()) {
    Relay relay(*system);
    const Asked whole(relay), stiff(*relay.stiff), soft(*relay.soft);
    const Counts c =
        run(method_named(form.name), relay, p.initial, 1, {.step_size = 0.01}).summary.counts;
    BOOST_TEST(whole.force == c.force_evaluations);
    BOOST_TEST(stiff.stiffness == c.stiffness_evaluations);
    BOOST_TEST(stiff.force + soft.force == 0);
    BOOST_TEST(soft.stiffness + whole.stiffness == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
