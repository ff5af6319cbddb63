// Systems that throw or give no number, and runs that are stopped.
#include <limits>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(failures)

using namespace qddot;

namespace {

constexpr double until = 4;  // s, in which explicit methods too look at K more than once
Options options_for(const Method& method) { return options_of(method, 0.01, 1e-6); }

using Spoil = void (*)(double& entry);
void break_it(double&) { throw std::runtime_error("the spring broke"); }
void lose_it(double& entry) { entry = NAN; }
void overflow(double& entry) { entry = INFINITY; }

// A hammock that the method applies to. The forces or stiffnesses of one of its relays are spoiled
// from one of them on.
struct Spoiled {
  Spoiled(const Method& method, std::size_t which, bool in_matrix)
      : problem(problem_for(method)),
        system(make_mass_spring(problem.network)),
        relay(*system),
        integrator(make_integrator(method, relay, options_for(method))),
        only_bounds_steps(in_matrix && (!method.is(Trait::implicit) || which == 2)) {
    Relay& half = *relay.all()[which];
    const auto pass = [this](double& entry) {
      if (++calls >= first_bad) spoil(entry);
    };
    if (in_matrix) {
      half.after_stiffness = [pass](const Vec&, SymmetricMatrix& k) { pass(k.coeffs()[0]); };
    } else {
      half.after_force = [pass](const ConstVec&, MutableVec f) { pass(f[0]); };
    }
  }
  // The number of evaluations in a run that goes well.
  int evaluations() {
    calls = 0;
    first_bad = std::numeric_limits<int>::max();
    State state = problem.initial;
    BOOST_TEST(integrator->advance(state, until).message == "");
    return calls;
  }
  Run run(int first, Spoil how) {
    calls = 0;
    first_bad = first;
    spoil = how;
    Run r{{}, problem.initial};
    try {
      r.summary = integrator->advance(r.state, until);
    } catch (const std::runtime_error& error) {
      r.thrown = error.what();
    }
    return r;
  }

  Problem problem;
  std::unique_ptr<System> system;
  Relay relay;
  std::unique_ptr<Integrator> integrator;
  bool only_bounds_steps;  // a matrix of an explicit method, or of the soft half
  int calls = 0, first_bad = 0;
  Spoil spoil = break_it;
};

// Checks each relay of the method's system, for forces and for stiffnesses. The first that it is
// asked for is spoiled, or a later one.
template <class Check>
void for_all_spoiled(const Method& method, const Check& check) {
  const Problem p = problem_for(method);
  const auto system = make_mass_spring(p.network);
  for (std::size_t which = 0; which < Relay(*system).all().size(); ++which) {
    for (const bool in_matrix : {false, true}) {
      Spoiled spoiled(method, which, in_matrix);
      const int all = spoiled.evaluations();
      for (const int first_bad : {1, std::max(2, all / 2)}) {
        if (all < first_bad) continue;
        BOOST_TEST_CONTEXT((in_matrix ? "stiffness " : "force ")
                           << first_bad << " of " << all << " of relay " << which) {
          check(spoiled, first_bad, in_matrix);
        }
      }
    }
  }
}

// The error of a state of a run that has ended early. It is that of tolerances where steps depend
// on the time left, where iterations begin anew and where a force at the end completes the state.
double allowed(const Method& method) {
  return method.knob == Knob::rtol || method.recurrence_roots ? 1e-2 : 1e-6;
}
void check_ended_early(const Method& method, const Spoiled& spoiled, const Run& r, bool in_matrix,
                       int first_bad) {
  BOOST_TEST(is_finite(r.state));
  BOOST_TEST(r.state.t < until);
  if (!in_matrix) BOOST_TEST((r.state.t > 0) == (first_bad > 1));
  // The later force is that of half of the steps, or of a few less where a run begins with many.
  if (!in_matrix && first_bad > 1 && method.knob == Knob::step_size)
    BOOST_TEST(r.state.t > 0.4 * until);
  if (r.state.t == 0) {
    BOOST_TEST(same(r.state, spoiled.problem.initial));
    return;
  }
  const State right =
      run(method, *spoiled.system, spoiled.problem.initial, r.state.t, options_for(method)).state;
  BOOST_TEST(distance(r.state, right) < allowed(method));
}

// Runs that failed leave nothing behind in the integrator.
void check_runs_again(const Method& method, Spoiled& spoiled) {
  spoiled.first_bad = std::numeric_limits<int>::max();
  State again = spoiled.problem.initial;
  BOOST_TEST(spoiled.integrator->advance(again, 1).message == "");
  const Run fresh = run(method, *spoiled.system, spoiled.problem.initial, 1, options_for(method));
  BOOST_TEST(same(again, fresh.state));
}

}  // namespace

BOOST_DATA_TEST_CASE(an_exception_in_the_system_comes_out_as_itself, methods(), method) {
  for_all_spoiled(method, [&](Spoiled& spoiled, int first_bad, bool in_matrix) {
    const Run r = spoiled.run(first_bad, break_it);
    BOOST_TEST(r.thrown == "the spring broke");
    BOOST_TEST(spoiled.calls == first_bad);  // nothing is asked for again
    check_ended_early(method, spoiled, r, in_matrix, first_bad);
    check_runs_again(method, spoiled);
  });
}

BOOST_DATA_TEST_CASE(what_is_no_number_is_named, methods(), method) {
  for_all_spoiled(method, [&](Spoiled& spoiled, int first_bad, bool in_matrix) {
    if (spoiled.only_bounds_steps) return;
    // A step by an infinite force is one beyond all bounds to some.
    const bool may_overflow = first_bad == 1 && method.is(Trait::interpolates);
    const Run r = spoiled.run(first_bad, may_overflow ? overflow : lose_it);
    const auto outcome = r.summary.outcome;
    // Library methods take it for a matrix that is of no use.
    BOOST_TEST((outcome == Outcome::not_finite || (in_matrix && outcome != Outcome::reached_end)),
               r.summary.message);
    BOOST_TEST(r.summary.message.find('\n') == std::string::npos);
    BOOST_TEST(r.summary.t_reached == r.state.t);
    if (!in_matrix) BOOST_TEST(r.summary.message.starts_with("a force "), r.summary.message);
    check_ended_early(method, spoiled, r, in_matrix, first_bad);
    check_runs_again(method, spoiled);
  });
}

BOOST_DATA_TEST_CASE(a_run_can_be_stopped_between_two_steps, methods(), method) {
  const Problem p = problem_for(method);
  const auto system = make_mass_spring(p.network);
  std::stop_source budget;
  Relay relay(*system);
  for (Relay* half : relay.all()) {
    half->after_force = [&, calls = 0](const ConstVec&, MutableVec) mutable {
      if (++calls == 200) budget.request_stop();
    };
  }
  const Options options = options_for(method);
  const Run r = run(method, relay, p.initial, 100, options, {}, budget.get_token());
  BOOST_TEST(name(r.summary.outcome) == "over_budget");
  BOOST_TEST(r.summary.message == advice(Outcome::over_budget));
  BOOST_TEST((r.state.t > 0 && r.state.t < 5));
  if (method.is(Trait::interpolates)) BOOST_TEST(r.summary.counts.force_evaluations < 220);
  BOOST_TEST(r.summary.t_reached == r.state.t);
  const State right = run(method, *system, p.initial, r.state.t, options).state;
  BOOST_TEST(distance(r.state, right) < allowed(method));
}

BOOST_AUTO_TEST_SUITE_END()
