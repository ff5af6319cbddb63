#include <boost/test/unit_test.hpp>

#include "integrators/sundials/version.hpp"
#include "tests/integrators/motions.hpp"

BOOST_AUTO_TEST_SUITE(relaxed)

using namespace qddot;

namespace {

std::vector<Method> relaxing() {
  auto list = methods_of(Knob::rtol);
  std::erase_if(list, [](const Method& method) { return !method.asks(Need::potential); });
  return list;
}

struct Steps {
  std::vector<State> ends{};
  Run run{};
};
Steps steps_of(const Method& method, const System& system, const State& start, double t_end,
               double rtol) {
  Steps steps;
  Observer observer;
  observer.step = [&](const State& state) { steps.ends.push_back(state); };
  steps.run = run(method, system, start, t_end, {.rtol = rtol}, observer);
  return steps;
}

// The largest change of the energy at the end of a step but the last, and that of the end [J].
struct Changes {
  double largest = 0, last = 0;
};
Changes changes(const Steps& steps, const System& system, const State& start) {
  const double energy = total_energy(system, start);
  Changes result;
  for (const State& end : steps.ends) {
    result.largest = std::max(result.largest, result.last);
    result.last = std::abs(total_energy(system, end) - energy);
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(they_come_with_sundials_7_1) {
  BOOST_TEST(relaxing().size() == (QDDOT_SUNDIALS >= 70100 ? 3 : 0));
}

BOOST_AUTO_TEST_CASE(every_step_but_the_last_keeps_the_energy) {
  for (const KnownMotion& motion : {linear(), nonlinear()}) {
    const System& system = *motion.system;
    for (const Method& method : relaxing()) {
      const std::string plain = "arkode_erk" + std::to_string(method.order);
      for (const double rtol : {1e-3, 1e-6}) {
        BOOST_TEST_CONTEXT(motion.name << ", " << method.name << " at " << rtol) {
          const Steps kept = steps_of(method, system, motion.start, 50, rtol);
          const Steps drifting = steps_of(method_named(plain), system, motion.start, 50, rtol);
          BOOST_TEST(kept.run.summary.message == "");
          BOOST_TEST(kept.run.state.t == 50);
          const Changes relaxed = changes(kept, system, motion.start);
          const double size = system.kinetic(motion.start.v) + system.potential(motion.start);
          // Each step leaves 1e-13 of the energy and less, with either sign.
          const double steps = static_cast<double>(kept.ends.size());
          BOOST_TEST(relaxed.largest < 1e-13 * steps * size);
          BOOST_TEST(changes(drifting, system, motion.start).largest > 1000 * relaxed.largest);
          // The last step errs as a step of the table.
          BOOST_TEST(relaxed.last < 2 * rtol * size);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_round_of_newtons_method_costs_a_force_and_there_is_about_one_a_step) {
  const KnownMotion motion = nonlinear();
  for (const auto& [order, stages] : {std::pair{4, 5}, {5, 6}, {6, 8}}) {
    for (const Method& method : relaxing()) {
      if (method.order != order) continue;
      const Counts counts =
          steps_of(method, *motion.system, motion.start, 50, 1e-6).run.summary.counts;
      const auto steps = static_cast<double>(counts.steps + counts.rejected);
      BOOST_TEST(static_cast<double>(counts.force_evaluations) < (stages + 1.5) * steps);
    }
  }
}

BOOST_AUTO_TEST_CASE(states_between_steps_change_nothing_in_a_run) {
  for (const KnownMotion& motion : {linear(), nonlinear()}) {
    for (const Method& method : relaxing()) {
      for (const double rtol : {1e-2, 1e-5, 1e-9}) {
        Film film;
        for (int i = 1; i <= 313; ++i) film.times.push_back(2. * i / 313);
        const Run a = run(method, *motion.system, motion.start, 2, {.rtol = rtol}, film.observer());
        const Run b = run(method, *motion.system, motion.start, 2, {.rtol = rtol});
        BOOST_TEST(same(a.state, b.state));
        BOOST_TEST(same(film.seen.back(), b.state));
        Counts counts = a.summary.counts;
        BOOST_TEST(counts.force_evaluations > b.summary.counts.force_evaluations);
        counts.force_evaluations = b.summary.counts.force_evaluations;
        BOOST_TEST(counts == b.summary.counts);
      }
    }
  }
}

// Two masses on a spring of 1e7 N/m. Far from the origin its length rounds by far more than 1e-16
// m, from the start or, if it is not stretched there, later.
BOOST_AUTO_TEST_CASE(where_v_rounds_coarsely_a_run_goes_on) {
  for (const double away : {0., 1e3, 1e6}) {
    for (const double stretch : {0., 0.01}) {
      Problem p{{.dimension = 2, .node_mass = Vec::Ones(2)},
                {0, Vec{{away, away, away + 1 + stretch, away}}, Vec{{10, 1, -10, -1}}}};
      p.network.links = {{0, 1, {.stiffness = 1e7, .rest_length = 1}}};
      const auto system = make_mass_spring(p.network);
      for (const Method& method : relaxing()) {
        for (const double rtol : {1e-4, 1e-8}) {
          BOOST_TEST_CONTEXT(method.name << " at " << rtol << ", " << away << " m away") {
            const Run r = run(method, *system, p.initial, 0.05, {.rtol = rtol});
            BOOST_TEST(r.summary.message == "");
          }
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_force_that_is_not_that_of_the_potential_ends_the_run) {
  const Problem p = Oscillator().problem();
  const auto system = make_mass_spring(p.network);
  Relay relay(*system);
  relay.after_force = [](const ConstVec&, MutableVec f) { f *= 2; };
  for (const Method& method : relaxing()) {
    const Run r = run(method, relay, p.initial, 1, {.rtol = 1e-6});
    BOOST_TEST(name(r.summary.outcome) == "solver_failed");
    BOOST_TEST(r.summary.message.starts_with("no part of a step that keeps the energy was found"));
  }
}

BOOST_AUTO_TEST_SUITE_END()
