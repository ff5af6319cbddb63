#include <stdexcept>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(times)

using namespace qddot;
using namespace std::string_literals;

BOOST_AUTO_TEST_CASE(time_does_not_drift_over_many_steps) {
  // A running sum of a million times 0.1 would be off by 1e-6.
  const Problem p = Oscillator{.mass = 1, .stiffness = 1}.problem();
  Film film{{99999.9}};
  const Run r = run(method_named("verlet"), p, 100000, {.step_size = 0.1}, film.observer());
  BOOST_TEST(r.summary.counts.steps == 1000000);
  BOOST_TEST(film.seen.at(0).t == 99999.9);
}

BOOST_DATA_TEST_CASE(a_run_to_its_own_start_changes_nothing, unconstrained_methods(), method) {
  Problem p = problem_for(method);
  p.initial.t = 2.5;
  const Run r = run(method, p, 2.5, options_of(method, 0.1, 1e-4));
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(same(r.state, p.initial));
  BOOST_TEST(r.summary.counts == (Counts{}));
}

BOOST_DATA_TEST_CASE(an_exception_of_the_observer_comes_out_as_itself, general_methods(), method) {
  const auto refuse = [](const State&) { throw std::runtime_error("seen enough"); };
  const Run r = run(method, hammock(2), 1, options_of(method, 0.02, 1e-5), {{0.3}, refuse});
  BOOST_TEST(r.thrown == "seen enough");
  BOOST_TEST(r.state.t == 0.3);
  BOOST_TEST(is_finite(r.state));
}

// A run that starts with steps of 1e-6 s ends with steps of 1e-2 s, for which other pivots are
// good.
BOOST_DATA_TEST_CASE(a_stiff_run_is_repeated_though_its_last_steps_are_long, methods_of(Knob::rtol),
                     method) {
  const Model scene = framed_cloth(10);
  if (!evaluates_stiffness(method) || method.asks(Need::split_forces)) return;
  const auto integrator = make_integrator(method, scene.system(), {.rtol = 1e-3, .speed = 3});
  State first = scene.initial(), second = scene.initial();
  const Summary a = integrator->advance(first, 0.1), b = integrator->advance(second, 0.1);
  BOOST_TEST(name(b.outcome) == name(a.outcome));
  BOOST_TEST(b.counts == a.counts);
  BOOST_TEST(same(first, second));
}

BOOST_DATA_TEST_CASE(exactly_the_methods_that_remember_no_steps_run_in_two_halves_as_in_one,
                     methods_where([](const Method& m) { return m.knob == Knob::step_size; }),
                     method) {
  const Options options{.step_size = 1. / 64, .solve_tolerance = 1e-13};
  std::vector<Problem> problems = {problem_for(method, 3)};
  if (is_general(method)) problems.push_back(linear_hammock(3));
  for (const Problem& p : problems) {
    const auto system = make_mass_spring(p.network);
    const auto integrator = make_integrator(method, *system, options);
    State state = p.initial;
    integrator->advance(state, 0.5);
    integrator->advance(state, 1);
    const State whole = run(method, *system, p.initial, 1, options).state;
    const double apart = distance(state, whole);
    // A constant K is assembled again at the start of the second half, and rounds differently
    // there. Methods that iterate have other factors then, which change each step by 1e-13, and
    // ones that extrapolate their iterations enlarge rounding.
    const bool is_solved =
        system->stiffness_is_constant() || method.listens_to(Option::solve_tolerance);
    const bool is_rough =
        method.family == Family::sundials || method.listens_to(Option::iterations);
    if (method.is(Trait::remembers_steps)) {
      BOOST_TEST(apart > 1e-13);
    } else {
      BOOST_TEST(apart <= (is_rough ? 1e-8 : is_solved ? 1e-11 : 0));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
