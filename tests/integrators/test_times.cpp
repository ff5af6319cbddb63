#include <numeric>
#include <stdexcept>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/fixed_step.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(times)

using namespace qddot;
using namespace std::string_literals;

namespace {

struct Hammock {
  Problem problem = hammock(2);
  std::unique_ptr<System> system = make_mass_spring(problem.network);
  Run run(const Method& method, double t_end, const Options& options,
          const Observer& observer = {}) const {
    return qddot::run(method, *system, problem.initial, t_end, options, observer);
  }
};

// Notes the times that it is shown.
struct Notes {
  std::vector<double> seen;
  std::function<void(const State&)> see = [this](const State& s) { seen.push_back(s.t); };
};

// Verlet with a kick that it forgets to renew at the start of a run.
class Forgetful final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  Outcome step(const State& now, double h, State& next) override {
    next.v = now.v + h / 2 * f_.cwiseQuotient(system().mass());
    next.q = now.q + h * next.v;
    force(next.q, f_);
    next.v += h / 2 * f_.cwiseQuotient(system().mass());
    return Outcome::reached_end;
  }

  Vec f_ = Vec::Zero(system().size());
};

// Whether the second of two runs of one object is the first again.
bool repeats(const Method& method) {
  const Hammock h;
  const auto integrator = make_integrator(method, *h.system, options_of(method, 0.01, 1e-5));
  State first = h.problem.initial, second = h.problem.initial;
  const Summary a = integrator->advance(first, 0.503), b = integrator->advance(second, 0.503);
  BOOST_REQUIRE(a.message == "");
  return same(first, second) && a.counts == b.counts && a.t_reached == b.t_reached &&
         b.message == "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_method_lands_on_the_end_exactly_also_between_steps) {
  Hammock h;
  h.problem.initial.t = 0.7;
  // 10, 10.3 and almost 11 steps, not too long for Newton's iteration without a line search; a
  // start and an end that are no binary fractions.
  for (const double t_end : {1.2, 1.215, 0.7 + 0.54995}) {
    for (const Method& method : general_methods()) {
      BOOST_TEST_CONTEXT(method.name << " to " << t_end) {
        const Run r = h.run(method, t_end, options_of(method, 0.05, 1e-4));
        if (r.summary.outcome == Outcome::diverged) continue;
        BOOST_TEST(r.summary.message == "");
        BOOST_TEST(r.state.t == t_end);
        BOOST_TEST(r.summary.t_reached == t_end);
        if (method.knob == Knob::step_size)
          BOOST_TEST(r.summary.counts.steps == (t_end > 1.2 ? 11 : 10));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(time_does_not_drift_over_many_steps) {
  // A running sum of a million times 0.1 would be off by 1e-6.
  const Problem p = Oscillator{.mass = 1, .stiffness = 1}.problem();
  const auto system = make_mass_spring(p.network);
  Notes notes;
  const Observer observer{.times = {99999.9}, .see = notes.see};
  const Run r =
      run(method_named("verlet"), *system, p.initial, 100000, {.step_size = 0.1}, observer);
  BOOST_TEST(r.summary.counts.steps == 1000000);
  BOOST_TEST(notes.seen == std::vector{99999.9}, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(a_run_to_its_own_start_changes_nothing) {
  Hammock h;
  h.problem.initial.t = 2.5;
  for (const Method& method : general_methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      const Run r = h.run(method, 2.5, options_of(method, 0.1, 1e-4));
      BOOST_TEST(r.summary.message == "");
      BOOST_TEST(same(r.state, h.problem.initial));
      BOOST_TEST(r.summary.counts == (Counts{}));
    }
  }
}

BOOST_AUTO_TEST_CASE(an_observer_sees_its_times_exactly_and_in_order) {
  const Hammock h;
  const std::vector<double> times = {0.01, 0.1, 1. / 3, 0.35, 0.6};
  for (const Method& method : general_methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      Notes notes;
      const Run r = h.run(method, 0.6, options_of(method, 0.02, 1e-5), {times, notes.see});
      BOOST_TEST(r.summary.message == "");
      BOOST_TEST(notes.seen == times, boost::test_tools::per_element());
      BOOST_TEST(r.state.t == 0.6);
    }
  }
}

BOOST_AUTO_TEST_CASE(an_observer_at_the_ends_of_steps_changes_nothing) {
  const Hammock h;
  for (const Method& method : methods_of(Knob::step_size)) {
    BOOST_TEST_CONTEXT(method.name) {
      const Options options{.step_size = 1. / 64};
      Notes notes;
      const Run watched = h.run(method, 1, options, {{0.25, 0.5, 1}, notes.see});
      const Run alone = h.run(method, 1, options);
      BOOST_TEST(same(watched.state, alone.state));
      BOOST_TEST(watched.summary.counts == alone.summary.counts);
    }
  }
}

BOOST_AUTO_TEST_CASE(an_exception_of_the_observer_comes_out_as_itself) {
  const Hammock h;
  for (const Method& method : general_methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      const auto refuse = [](const State&) { throw std::runtime_error("seen enough"); };
      const Run r = h.run(method, 1, options_of(method, 0.02, 1e-5), {{0.3}, refuse});
      BOOST_TEST(r.thrown == "seen enough");
      BOOST_TEST(r.state.t == 0.3);
      BOOST_TEST(is_finite(r.state));
    }
  }
}

BOOST_AUTO_TEST_CASE(an_integrator_run_twice_from_one_start_ends_the_same_to_the_last_bit) {
  for (const Method& method : general_methods()) {
    BOOST_TEST_CONTEXT(method.name) { BOOST_TEST(repeats(method)); }
  }
}

// A run that starts with steps of 1e-6 s ends with steps of 1e-2 s, for which other pivots are
// good.
BOOST_AUTO_TEST_CASE(a_stiff_run_is_repeated_though_its_last_steps_are_long) {
  const ReducedScene scene = framed_cloth(10);
  for (const Method& method : methods_of(Knob::rtol)) {
    if (!evaluates_stiffness(method) || method.asks(Need::split_forces)) continue;
    BOOST_TEST_CONTEXT(method.name) {
      const auto integrator = make_integrator(method, scene.system(), {.rtol = 1e-3, .speed = 3});
      State first = scene.initial(), second = scene.initial();
      const Summary a = integrator->advance(first, 0.1), b = integrator->advance(second, 0.1);
      BOOST_TEST(name(b.outcome) == name(a.outcome));
      BOOST_TEST(b.counts == a.counts);
      BOOST_TEST(same(first, second));
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_left_of_the_run_before_is_noticed) {
  Method forgetful = method_named("verlet");
  forgetful.make = create<Forgetful>;
  BOOST_TEST(!repeats(forgetful));
}

BOOST_AUTO_TEST_CASE(one_step_methods_run_in_two_halves_as_in_one) {
  const Options options{.step_size = 1. / 64, .solve_tolerance = 1e-13};
  for (const char* method :
       {"explicit_euler", "symplectic_euler", "semi_implicit_euler", "implicit_euler", "verlet",
        "position_verlet", "rk4", "blanes_moan4", "blanes_moan6", "kahan_li8"}) {
    for (const Problem& p : {hammock(3), linear_hammock(3)}) {
      BOOST_TEST_CONTEXT(method) {
        const auto system = make_mass_spring(p.network);
        const auto integrator = make_integrator(method_named(method), *system, options);
        State state = p.initial;
        integrator->advance(state, 0.5);
        integrator->advance(state, 1);
        const State whole = run(method_named(method), *system, p.initial, 1, options).state;
        // A constant K is assembled again at the start of the second half, and rounds differently
        // there. Implicit Euler has other factors then, which change each step by 1e-13.
        const bool is_solved = system->stiffness_is_constant() || method == "implicit_euler"s;
        BOOST_TEST(distance(state, whole) <= (is_solved ? 1e-11 : 0));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
