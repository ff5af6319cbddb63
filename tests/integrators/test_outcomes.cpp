#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(outcomes)

using namespace qddot;

namespace {

constexpr double nan = NAN, infinity = INFINITY;

// Conditions on any run. Time and state are finite; both reported times are equal and not beyond
// the end. The end is reached exactly if the outcome says so, and else there is a message.
bool is_sound(const Run& r, double t_end) {
  const bool reached = r.summary.outcome == Outcome::reached_end;
  return is_finite(r.state) && r.state.t == r.summary.t_reached && r.state.t <= t_end &&
         (r.state.t == t_end || !reached) && r.summary.message.empty() == reached;
}

}  // namespace

BOOST_DATA_TEST_CASE(a_scene_without_unknowns_reaches_its_end, general_methods(), method) {
  const auto system = make_mass_spring({.node_mass = Vec(0)});
  const Run r = run(method, *system, {0, Vec(0), Vec(0)}, 1, options_of(method, 0.01, 1e-4));
  BOOST_TEST(name(r.summary.outcome) == "reached_end");
  BOOST_TEST(r.state.t == 1);
}

BOOST_DATA_TEST_CASE(a_start_or_an_end_that_is_no_number_is_refused, general_methods(), method) {
  const Problem p = hammock(2);
  for (const double bad : {nan, infinity, -infinity}) {
    BOOST_TEST_CONTEXT(method.name << " " << bad) {
      const Options options = options_of(method, 0.01, 1e-4);
      State bad_t = p.initial, bad_q = bad_t, bad_v = bad_t;
      bad_t.t = nan;
      bad_q.q[3] = bad;
      bad_v.v[0] = bad;
      BOOST_TEST(name(run(method, {p.network, bad_t}, 1, options).summary.outcome) == "not_finite");
      for (const State& start : {bad_q, bad_v}) {
        const Run r = run(method, {p.network, start}, 1, options);
        BOOST_TEST(name(r.summary.outcome) == "not_finite");
        BOOST_TEST(r.summary.message == "the start is not finite");
        BOOST_TEST(r.state.t == 0);
      }
      const Run endless = run(method, p, bad, options);
      BOOST_TEST(name(endless.summary.outcome) == "not_finite");
      BOOST_TEST(same(endless.state, p.initial));
    }
  }
}

BOOST_DATA_TEST_CASE(a_step_that_rounding_swallows_is_refused, methods_of(Knob::step_size),
                     method) {
  const Problem p = hammock(2);
  struct {
    double t_start, t_end, step_size;
  } const cases[] = {{0, 1, 1e-20}, {1e9, 1e9 + 1, 1e-8}, {-1e9, -1e9 + 1, 1e-8}};
  for (const auto& [t_start, t_end, step_size] : cases) {
    BOOST_TEST_CONTEXT(method.name << " with h = " << step_size << " from " << t_start) {
      const State start{t_start, p.initial.q, p.initial.v};
      const Run r = run(method, {p.network, start}, t_end, {.step_size = step_size});
      BOOST_TEST(name(r.summary.outcome) == "step_too_small");
      BOOST_TEST(r.summary.message == advice(Outcome::step_too_small));
      BOOST_TEST(same(r.state, start));
    }
  }
}

BOOST_DATA_TEST_CASE(a_step_that_rounding_just_does_not_swallow_is_taken,
                     methods_of(Knob::step_size), method) {
  // Times are 1.2e-7 apart at t = 1e9.
  const Problem p = hammock(2);
  const State start{1e9, p.initial.q, p.initial.v};
  const double t_end = 1e9 + 1e-3;
  const Run r = run(method, {p.network, start}, t_end, {.step_size = 1e-6});
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(r.state.t == t_end);
}

BOOST_DATA_TEST_CASE(a_run_stopped_before_it_starts_leaves_its_state, general_methods(), method) {
  const Problem p = hammock(2);
  std::stop_source budget;
  budget.request_stop();
  const Run r = run(method, p, 1, options_of(method, 0.01, 1e-4), {}, budget.get_token());
  BOOST_TEST(name(r.summary.outcome) == "over_budget");
  BOOST_TEST(r.summary.message == advice(Outcome::over_budget));
  BOOST_TEST(same(r.state, p.initial));
  BOOST_TEST(r.summary.counts.steps == 0);
}

BOOST_DATA_TEST_CASE(a_run_stopped_on_its_way_ends_there, general_methods(), method) {
  const Problem p = hammock(2);
  std::stop_source budget;
  const Observer observer{{0.5}, [&](const State&) { budget.request_stop(); }};
  const Options options = options_of(method, 0.01, 1e-4);
  const Run r = run(method, p, 1, options, observer, budget.get_token());
  BOOST_TEST(name(r.summary.outcome) == "over_budget");
  BOOST_TEST(is_sound(r, 1));
  BOOST_TEST(r.state.t == 0.5);
  const State there = run(method, p, 0.5, options).state;
  // A method that steps on 0.5 only if that is its end agrees within some tolerances.
  BOOST_TEST(distance(r.state, there) <= (method.is(Trait::interpolates) ? 10 * options.rtol : 0));
}

BOOST_DATA_TEST_CASE(explicit_methods_far_above_their_limit_diverge_with_a_finite_state,
                     methods_of(Knob::step_size), method) {
  const Oscillator o;
  const Problem p = o.problem();
  const double h = 100 / o.omega();
  if (method.is(Trait::implicit)) return;
  const Run r = run(method, p, 1000 * h, {.step_size = h});
  BOOST_TEST(name(r.summary.outcome) == "diverged");
  BOOST_TEST(r.summary.message == advice(Outcome::diverged));
  BOOST_TEST(is_sound(r, 1000 * h));
  BOOST_TEST(r.state.t == static_cast<double>(r.summary.counts.steps) * h);
  BOOST_TEST(r.state.t < 1000 * h);
  BOOST_TEST(r.state.v.norm() < 1e30);
}

BOOST_AUTO_TEST_CASE(any_knob_however_coarse_ends_in_a_sound_state) {
  for (const Problem& p : {hammock(2), hammock(3), linear_hammock(2)}) {
    const auto system = make_mass_spring(p.network);
    for (const Method& method : general_methods()) {
      for (const double coarse : {0.3, 3., 100., 1e6}) {
        BOOST_TEST_CONTEXT(method.name << " " << coarse) {
          const double t_end = 50 * coarse;
          std::stop_source budget;  // 1e5 forces are hundreds a step
          Relay relay(*system);
          relay.after_force = [&, calls = 0](const ConstVec&, MutableVec) mutable {
            if (++calls == 100000) budget.request_stop();
          };
          const Run r = run(method, relay, p.initial, t_end, options_of(method, coarse, coarse), {},
                            budget.get_token());
          BOOST_TEST(is_sound(r, t_end), r.summary.message);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
