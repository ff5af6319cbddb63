#include <stdexcept>
#include <stop_token>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(sundials_failures)

using namespace qddot;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// All forces fail from the 40th on, and all stiffnesses from the third on.
void break_forces(Relay& relay) {
  relay.after_force = [calls = 0](const ConstVec&, MutableVec) mutable {
    if (++calls >= 40) throw std::runtime_error("the spring broke");
  };
}
void break_stiffnesses(Relay& relay) {
  relay.after_stiffness = [calls = 0](const Vec&, SymmetricMatrix&) mutable {
    if (++calls >= 3) throw std::runtime_error("the spring broke");
  };
}

constexpr double until = 30;  // s, in which the explicit methods too look at K some ten times
Options options_for(const Method& method) { return options_of(method, 0.01, 1e-6); }

// A method's run on a hammock that breaks.
struct BrokenRun {
  BrokenRun(const Method& method, void (*break_it)(Relay&))
      : integrator(make_integrator(method, relay, options_for(method))) {
    break_it(relay);
    try {
      integrator->advance(state, until);
    } catch (const std::runtime_error& error) {
      thrown = error.what();
    }
  }
  Problem problem = hammock(2);
  std::unique_ptr<System> system = make_mass_spring(problem.network);
  Relay relay{*system};
  std::unique_ptr<Integrator> integrator;
  State state = problem.initial;
  std::string thrown;
};

}  // namespace

BOOST_AUTO_TEST_CASE(an_exception_in_the_system_comes_out_as_itself) {
  for (const Method& method : methods_of(Family::sundials)) {
    for (const auto break_it : {break_forces, break_stiffnesses}) {
      if (break_it == break_stiffnesses && !evaluates_stiffness(method)) continue;
      BOOST_TEST_CONTEXT(method.name) {
        const BrokenRun r(method, break_it);
        BOOST_TEST(r.thrown == "the spring broke");
        BOOST_TEST(r.state.t > 0);
        BOOST_TEST(r.state.t < until);
        BOOST_TEST(is_finite(r.state));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(after_an_exception_the_same_integrator_runs_again) {
  for (const Method& method : methods_of(Family::sundials)) {
    BOOST_TEST_CONTEXT(method.name) {
      BrokenRun r(method, break_forces);
      r.relay.after_force = nullptr;
      State state = r.problem.initial;
      BOOST_TEST(r.integrator->advance(state, 1).message == "");
      BOOST_TEST(
          same(state, run(method, *r.system, r.problem.initial, 1, options_for(method)).state));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_force_that_becomes_no_number_ends_the_run_at_the_last_accepted_state) {
  const Oscillator o;
  const Problem p = o.problem();
  const auto system = make_mass_spring(p.network);
  for (const Method& method : methods_of(Family::sundials)) {
    BOOST_TEST_CONTEXT(method.name) {
      // The oscillator passes 0.2 m at about 0.2 s, and there is no force beyond. 1e5 forces are
      // thousands of times what it takes to get there.
      std::stop_source budget;
      Relay relay(*system);
      relay.after_force = [&, calls = 0](const ConstVec& q, MutableVec f) mutable {
        if (q[0] < 0.2) f[0] = NAN;
        if (++calls == 100000) budget.request_stop();
      };
      const Run r = run(method, relay, p.initial, 1, options_for(method), {}, budget.get_token());
      const auto outcome = r.summary.outcome;
      BOOST_TEST((outcome == Outcome::not_finite || outcome == Outcome::step_too_small),
                 r.summary.message);
      BOOST_TEST(is_finite(r.state));
      BOOST_TEST(r.state.t == r.summary.t_reached);
      BOOST_TEST(r.state.t > 0.15);
      // The end of a step is a sum of rates, differences of solutions, and its last stage a
      // solution: the same but for rounding.
      BOOST_TEST(r.state.q[0] > 0.2 - 1e-14);
      // Accepted states agree with the method's own motion to 1000 times the tolerance (see the
      // suite `sundials`). The tolerance at a constant step is that of Newton's iteration.
      const State whole = run(method, *system, p.initial, r.state.t, options_for(method)).state;
      BOOST_TEST(distance(r.state, whole) < (method.knob == Knob::rtol ? 1e-3 : 1e-7));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_message_of_sundials_reaches_the_summary_in_one_line) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  Relay relay(*system);
  relay.after_force = [](const ConstVec&, MutableVec f) { f[0] = NAN; };
  for (const Method& method : methods_of(Family::sundials)) {
    BOOST_TEST_CONTEXT(method.name) {
      const Run r = run(method, relay, p.initial, 1, options_for(method));
      BOOST_TEST(name(r.summary.outcome) == "not_finite");
      BOOST_TEST(contains(r.summary.message, " at t = 0 s: "));
      for (const char* library : {"ARKODE", "CVODE", "IDA"}) {
        const bool is_its = method.summary.find(library) != std::string::npos;
        BOOST_TEST(contains(r.summary.message, std::string("(") + library + " ") == is_its);
      }
      BOOST_TEST(!contains(r.summary.message, "\n"));
      BOOST_TEST(same(r.state, p.initial));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
