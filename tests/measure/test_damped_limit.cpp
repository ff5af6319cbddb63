// Steps and limits of stability on damped vibrations, against theory.
#include <complex>

#include <boost/test/unit_test.hpp>

#include "qddot/analysis/damped_step.hpp"
#include "qddot/measure/stability/linear_limit.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(damped_limit)

using namespace qddot;

namespace {

constexpr std::array ratios = {0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0};

// The largest h w up to which |R(h z)| <= 1 for both z = -zeta +- sqrt(zeta^2 - 1) of a method with
// the stability function R, by bisection from the first of a fine grid that grows.
template <class R>
double limit_of(const R& r, double zeta) {
  const std::complex<double> root = std::sqrt(std::complex<double>(zeta * zeta - 1));
  const auto grows = [&](double h) {
    return std::max(std::abs(r(h * (-zeta + root))), std::abs(r(h * (-zeta - root)))) > 1 + 1e-12;
  };
  double high = 0.02;
  while (!grows(high)) high *= 1.001;
  double low = high / 1.001;
  for (int i = 0; i < 60; ++i) (grows((low + high) / 2) ? high : low) = (low + high) / 2;
  return low;
}

}  // namespace

BOOST_AUTO_TEST_CASE(leapfrog_methods_have_the_limit_of_their_lag_to_1e8) {
  for (const char* name : {"verlet", "symplectic_euler"}) {
    const Method& method = method_named(name);
    for (const double zeta : ratios) {
      const double predicted = qddot::damped_limit(method, zeta);
      BOOST_TEST(std::abs(measured_limit(method, zeta) / predicted - 1) < 1e-8);
    }
    BOOST_TEST(qddot::damped_limit(method, 0) == 2);
  }
  BOOST_TEST(std::isnan(qddot::damped_limit(method_named("rk4"), 0.1)));
}

// Also of methods with memory, some of whose roots die later than the vibration.
BOOST_AUTO_TEST_CASE(the_damping_of_a_short_step_is_that_of_the_vibration) {
  for (const Method& method : methods()) {
    if (!has_linear_step(method) || method.takes_damping() != Damped::by_any || method.order < 2 ||
        !method.make)
      continue;
    for (const double zeta : {0.01, 0.1, 0.5}) {
      const LinearStep step = linear_step(method, 0.1, {}, zeta);
      // (h w)^2 = 1e-2 at order 2.
      BOOST_TEST(std::abs(step.damping_ratio() - zeta) <= 0.02, method.name << " " << zeta);
      BOOST_TEST(std::abs(step.period_error() - (1 / std::sqrt(1 - zeta * zeta) - 1)) <= 0.02,
                 method.name << " " << zeta);
    }
  }
}

BOOST_AUTO_TEST_CASE(rk4_has_the_limit_of_its_polynomial) {
  const auto r = [](std::complex<double> z) {
    return 1. + z * (1. + z / 2. * (1. + z / 3. * (1. + z / 4.)));
  };
  for (const double zeta : ratios) {
    const double measured = measured_limit(method_named("rk4"), zeta);
    BOOST_TEST(std::abs(measured / limit_of(r, zeta) - 1) < 1e-8);
  }
}

// The limits were found for the recurrences by themselves, to two digits.
BOOST_AUTO_TEST_CASE(symmetric4_has_the_limits_of_its_recurrence) {
  const Method& method = method_named("symmetric4");
  constexpr std::array<std::pair<double, double>, 4> known = {
      {{0.01, 1.735}, {0.1, 1.10}, {0.3, 0.53}, {1, 0.17}}};
  for (const auto& [zeta, limit] : known) {
    const double measured = measured_limit(method, zeta);
    BOOST_TEST(std::abs(measured - limit) < 0.01, measured);
    // From both sides, by whole runs of an oscillator with a start that excites all roots.
    Network network{.dimension = 1, .node_mass = Vec::Ones(1)};
    network.anchors = {{0, Eigen::Vector3d::Zero(), {.stiffness = 1, .damping = 2 * zeta}}};
    for (const double part : {0.97, 1.03}) {
      const double h = part * measured;
      const Run r = run(method, {network, {0, Vec{{1.}}, Vec{{1.}}}}, 3000 * h, {.step_size = h});
      const bool grew = r.summary.outcome != Outcome::reached_end || std::abs(r.state.q[0]) > 1;
      BOOST_TEST(grew == (part > 1));
    }
  }
}

// Four stages and more: vibrations lie on a circle through zero, of radius 1/beta, beta = 2 zeta/w.
BOOST_AUTO_TEST_CASE(rkc_is_stable_for_steps_of_two_damping_times) {
  const Method& method = method_named("rkc");
  for (const double zeta : {0.3, 1.0, 3.0, 10.0}) {
    const double beta = 2 * zeta;  // w = 1
    BOOST_TEST(measured_limit(method, zeta) > 2 * beta);
  }
}

BOOST_AUTO_TEST_CASE(exact_steps_have_the_roots_of_the_motion) {
  for (const double zeta : {0.0, 0.3, 0.999, 1.5, 8.0}) {
    const std::complex<double> root = std::sqrt(std::complex<double>(zeta * zeta - 1));
    const LinearStep step = linear_step(method_named("exact"), 0.7, {}, zeta);
    BOOST_TEST(std::abs(step.spectral_radius() - std::exp(0.7 * (-zeta + root).real())) < 1e-10);
    if (zeta < 1) BOOST_TEST(std::abs(step.damping_ratio() - zeta) < 1e-8);
  }
  BOOST_CHECK_THROW(linear_step(method_named("kahan_li8"), 0.1, {}, 0.1), std::invalid_argument);
}

// 4 M - 2 lag h C + h^2 K loses its definiteness at the limit.
BOOST_AUTO_TEST_CASE(the_limit_of_a_network_is_that_of_stiffer_springs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int sample = 0; sample < 12; ++sample) {
    Problem p = random_network(random, 1 + sample % 3, 12, 1.05);
    const double strength = std::pow(10, -2 + 0.3 * sample);
    for_springs(p.network, [&](auto& spring) { spring.law.damping = strength * uniform(random); });
    p.network.air_damping = 0.1 * strength;
    const auto system = make_mass_spring(p.network);
    SymmetricMatrix c = system->stiffness_pattern();
    system->damping()->damping_matrix(p.initial.q, c);
    const Eigen::MatrixXd k = dense(stiffness_at(*system, p.initial.q)), full = dense(c),
                          m = Vec(system->mass()).asDiagonal();
    for (const double lag : {1.0, 2.0}) {
      const double h = damped_step_limit(*system, p.initial.q, lag);
      const auto least = [&](double step) {
        return smallest_eigenvalue(4 * m - 2 * lag * step * full + step * step * k);
      };
      // Lanczos' frequencies are good to 1e-4.
      BOOST_TEST(least(0.999 * h) > 0);
      BOOST_TEST(least(1.001 * h) < 0);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
