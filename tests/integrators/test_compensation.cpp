#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/compensated_sum.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(compensation)

using namespace qddot;

namespace {

// The quadratic form that is conserved by a step (q, v) -> A (q, v) of determinant 1:
//   c q^2 + (d - a) q v - b v^2 with A = (a b; c d).
struct Form {
  double qq, qv, vv;
  double at(double q, double v) const { return qq * q * q + qv * q * v + vv * v * v; }
};

// q'' = -q.
const Network unit_oscillator = {
    .dimension = 1, .node_mass = Vec::Ones(1), .anchors = {{0, {0, 0, 0}, {.stiffness = 1}}}};

Form kept_form(const Method& method, const System& system, double h) {
  const auto column = [&](double q, double v) {
    return run(method, system, {0, Vec::Constant(1, q), Vec::Constant(1, v)}, h, {.step_size = h})
        .state;
  };
  const State one = column(1, 0), other = column(0, 1);
  return {one.v[0], other.v[0] - one.q[0], -other.q[0]};
}

// The largest relative change of the form by steps of h.
double largest_change(const Method& method, double h, int steps, bool compensated) {
  const auto system = make_mass_spring(unit_oscillator);
  const Form form = kept_form(method, *system, h);
  const double start = form.at(1, 0.3);
  double largest = 0;
  Observer observer{{}, [&](const State& state) {
                      const double now = form.at(state.q[0], state.v[0]);
                      largest = std::max(largest, std::abs(now - start) / std::abs(start));
                    }};
  for (int k = 100; k <= steps; k += 100) observer.times.push_back(k * h);
  run(method, *system, {0, Vec::Ones(1), Vec::Constant(1, 0.3)}, steps * h,
      {.step_size = h, .compensated = compensated}, observer);
  return largest;
}

// The largest energy error of an orbit, by what is too accurate to err by anything but rounding.
double orbit_energy_error(bool compensated) {
  const Scene scene = generate(*find_generator("orbit"), {}, "orbit");
  const Model orbit(scene);
  const double start = orbit.energy(orbit.initial()), h = 0.004;
  double largest = 0;
  Observer observer{{}, [&](const State& state) {
                      largest = std::max(largest, std::abs(orbit.energy(state) - start) / start);
                    }};
  for (int k = 50; k <= 50000; k += 50) observer.times.push_back(k * h);
  run(method_named("kahan_li8"), orbit.system(), orbit.initial(), 50000 * h,
      {.step_size = h, .compensated = compensated}, observer);
  return largest;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_sum_keeps_what_rounding_takes_from_it) {
  for (const bool is_on : {true, false}) {
    CompensatedSum sum(is_on, 3);
    Vec x = Vec::Ones(3);
    for (int i = 0; i < 1000000; ++i) sum.add_scaled(x, 1e-17, Vec::Ones(3), x);
    // Each increment alone is too small to change 1; the sum is right to half a unit of its last
    // place.
    BOOST_TEST(std::abs(x[0] - (1 + 1e-11)) <= (is_on ? 1.2e-16 : 1.1e-11));
    BOOST_TEST((x[0] > 1) == is_on);
    sum.restart();
    const Vec before = x;
    sum.add_scaled(x, 0, Vec::Zero(3), x);
    BOOST_TEST(x == before);
  }
}

BOOST_DATA_TEST_CASE(the_invariant_of_each_splitting_keeps_ten_times_better,
                     methods_with(Option::compensated), method) {
  const int steps = method.order > 2 ? 200000 : 1000000;
  const double plain = largest_change(method, 0.01, steps, false);
  const double compensated = largest_change(method, 0.01, steps, true);
  // sqrt(steps) roundings of 1e-16 and more, and a few hundredths of that.
  BOOST_TEST(plain > 1e-14);
  BOOST_TEST(plain < 1e-11);
  BOOST_TEST(compensated < plain / 10);
}

BOOST_AUTO_TEST_CASE(the_energy_of_an_orbit_keeps_ten_times_better) {
  const double plain = orbit_energy_error(false);
  BOOST_TEST(plain > 1e-14);
  BOOST_TEST(orbit_energy_error(true) < plain / 10);
}

BOOST_DATA_TEST_CASE(a_run_begins_without_the_rest_of_the_one_before,
                     methods_with(Option::compensated), method) {
  const auto system = make_mass_spring(unit_oscillator);
  const Options options{.step_size = 0.1, .compensated = true};
  const auto integrator = make_integrator(method, *system, options);
  const State start{0, Vec::Ones(1), Vec::Constant(1, 0.3)};
  State once = start, again = start;
  integrator->advance(once, 10);
  integrator->advance(again, 10);
  BOOST_TEST(same(once, again), method.name);
  // It is another motion than the plain one, by rounding.
  const State plain = run(method, *system, start, 10, {.step_size = 0.1}).state;
  BOOST_TEST(distance(once, plain) < 1e-13);
  BOOST_TEST(distance(once, plain) > 0);
}

BOOST_AUTO_TEST_SUITE_END()
