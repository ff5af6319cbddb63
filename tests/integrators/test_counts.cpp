#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/fixed_step.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(counts)

using namespace qddot;

namespace {

constexpr std::int64_t steps = 37;
constexpr double h = 0.01;

Counts count(const Method& method, const Problem& p, double t_end, const Observer& observer = {}) {
  const auto system = make_mass_spring(p.network);
  const Run r = run(method, *system, p.initial, t_end, {.step_size = h}, observer);
  BOOST_REQUIRE(r.summary.message == "");
  return r.summary.counts;
}

// A run of 37 whole steps.
Counts count(const char* method, const Problem& p) {
  return count(method_named(method), p, steps * h);
}

// A run of 37 whole steps and a shorter one.
Counts count_with_rest(const char* method, const Problem& p) {
  return count(method_named(method), p, (steps + 0.4) * h);
}

// Counts the calls that arrive at a system.
struct Watch {
  explicit Watch(const System& system) : relay(system) {
    relay.after_force = [this](const ConstVec&, MutableVec) { ++forces; };
    relay.after_stiffness = [this](const Vec&, SymmetricMatrix&) { ++stiffnesses; };
  }
  Relay relay;
  std::int64_t forces = 0, stiffnesses = 0;
};

// Evaluates a force that it does not need.
class Wasteful final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  Outcome step(const State& now, double size, State& next) override {
    for (int i = 0; i < 2; ++i) force(now.q, f_);
    next.v = now.v + size * f_.cwiseQuotient(system().mass());
    next.q = now.q + size * next.v;
    return Outcome::reached_end;
  }

  Vec f_{system().size()};
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_two_explicit_eulers_take_one_force_a_step) {
  for (const char* method : {"explicit_euler", "symplectic_euler"}) {
    for (const Problem& p : {linear_hammock(2), hammock(2)}) {
      BOOST_TEST(count(method, p) == (Counts{.steps = steps, .force_evaluations = steps}));
    }
  }
}

BOOST_AUTO_TEST_CASE(verlet_takes_one_force_a_step_and_one_to_begin) {
  BOOST_TEST(count("verlet", hammock(2)) ==
             (Counts{.steps = steps, .force_evaluations = steps + 1}));
}

BOOST_AUTO_TEST_CASE(
    other_splittings_take_a_force_a_drift_and_one_to_begin_if_they_begin_with_a_kick) {
  const std::tuple<const char*, int, int> expected[] = {{"position_verlet", 1, 0},
                                                        {"blanes_moan4", 6, 1},
                                                        {"blanes_moan6", 11, 1},
                                                        {"kahan_li8", 17, 1}};
  for (const auto& [method, of_a_step, to_begin] : expected) {
    BOOST_TEST_CONTEXT(method) {
      BOOST_TEST(count(method, hammock(2)) ==
                 (Counts{.steps = steps, .force_evaluations = of_a_step * steps + to_begin}));
    }
  }
}

BOOST_AUTO_TEST_CASE(rk4_takes_four_forces_a_step) {
  BOOST_TEST(count("rk4", hammock(2)) == (Counts{.steps = steps, .force_evaluations = 4 * steps}));
}

BOOST_AUTO_TEST_CASE(an_observer_costs_no_evaluation_at_the_ends_of_steps) {
  const Observer observer{.times = {5 * h, 20 * h}, .see = [](const State&) {}};
  BOOST_TEST(count(method_named("verlet"), hammock(2), steps * h, observer) ==
             (Counts{.steps = steps, .force_evaluations = steps + 1}));
}

BOOST_AUTO_TEST_CASE(semi_implicit_euler_factorises_once_a_step_where_k_changes) {
  BOOST_TEST(count("semi_implicit_euler", hammock(2)) == (Counts{.steps = steps,
                                                                 .force_evaluations = steps,
                                                                 .stiffness_evaluations = steps,
                                                                 .factorizations = steps,
                                                                 .solves = steps}));
}

BOOST_AUTO_TEST_CASE(semi_implicit_euler_factorises_once_a_run_where_k_is_constant) {
  BOOST_TEST(count("semi_implicit_euler", linear_hammock(2)) == (Counts{.steps = steps,
                                                                        .force_evaluations = steps,
                                                                        .stiffness_evaluations = 1,
                                                                        .factorizations = 1,
                                                                        .solves = steps}));
}

BOOST_AUTO_TEST_CASE(implicit_euler_takes_one_iteration_a_step_and_one_factor_where_k_is_constant) {
  BOOST_TEST(count("implicit_euler", linear_hammock(2)) == (Counts{.steps = steps,
                                                                   .force_evaluations = steps,
                                                                   .stiffness_evaluations = 1,
                                                                   .factorizations = 1,
                                                                   .solves = steps,
                                                                   .newton_iterations = steps}));
}

BOOST_AUTO_TEST_CASE(a_shortened_last_step_costs_a_second_factorisation) {
  for (const char* method : {"semi_implicit_euler", "implicit_euler"}) {
    const Counts c = count_with_rest(method, linear_hammock(2));
    BOOST_TEST(c.steps == steps + 1);
    BOOST_TEST(c.factorizations == 2);
    BOOST_TEST(c.stiffness_evaluations == 2);
  }
}

BOOST_AUTO_TEST_CASE(implicit_euler_takes_what_its_iterations_take_where_k_changes) {
  // Without compression that outweighs the mass every factorisation succeeds at once and every
  // full correction is accepted; the last iteration of a step needs no new force. One factorisation
  // is enough for motion as smooth as this.
  const Counts c = count("implicit_euler", hammock(2));
  BOOST_TEST(c.newton_iterations > steps);
  BOOST_TEST(c.newton_iterations <= 5 * steps);
  BOOST_TEST(c == (Counts{.steps = steps,
                          .force_evaluations = c.newton_iterations,
                          .stiffness_evaluations = 1,
                          .factorizations = 1,
                          .solves = c.newton_iterations,
                          .newton_iterations = c.newton_iterations}));
}

BOOST_AUTO_TEST_CASE(counts_are_added_one_by_one) {
  Counts sum{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  sum += {100, 200, 300, 400, 500, 600, 700, 800, 900, 1000, 1100};
  BOOST_TEST(sum == (Counts{101, 202, 303, 404, 505, 606, 707, 808, 909, 1010, 1111}));
}

BOOST_AUTO_TEST_CASE(every_method_counts_each_call_that_reaches_the_system) {
  const Problem p = hammock(3);
  const auto system = make_mass_spring(p.network);
  for (const Method& method : general_methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      Watch watch(*system);
      const auto integrator = make_integrator(method, watch.relay, options_of(method, 0.01, 1e-5));
      watch.forces = watch.stiffnesses = 0;  // what was asked for before the run is not of it
      State state = p.initial;
      const Summary summary = integrator->advance(state, 0.3);
      BOOST_TEST(summary.message == "");
      BOOST_TEST(summary.counts.force_evaluations == watch.forces);
      BOOST_TEST(summary.counts.stiffness_evaluations == watch.stiffnesses);
    }
  }
}

BOOST_AUTO_TEST_CASE(one_force_too_many_is_noticed) {
  Method wasteful = method_named("symplectic_euler");
  wasteful.make = create<Wasteful>;
  const Counts c = count(wasteful, hammock(2), steps * h);
  BOOST_TEST(!(c == count("symplectic_euler", hammock(2))));
  BOOST_TEST(c.force_evaluations == 2 * steps);
}

BOOST_AUTO_TEST_SUITE_END()
