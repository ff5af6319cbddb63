#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(between_steps)

using namespace qddot;

namespace {

constexpr double golden = 0.6180339887498949;

std::vector<Method> methods_of_fixed_steps() {
  return methods_where([](const Method& method) { return method.knob == Knob::step_size; });
}

// A time in each step of h, at an irregular place.
std::vector<double> one_a_step(double h, double t_end) {
  std::vector<double> times;
  for (int i = 0; (i + 1) * h <= t_end; ++i) times.push_back((i + std::fmod(i * golden, 1)) * h);
  times.erase(times.begin());
  return times;
}

// A problem in which every method is exact up to rounding: a mass without forces, with t = x.
Problem flight() {
  return {{.dimension = 1, .node_mass = Vec::Ones(1), .offers_split = true},
          {0, Vec::Zero(1), Vec::Ones(1)}};
}

}  // namespace

BOOST_DATA_TEST_CASE(what_is_observed_changes_no_run_of_fixed_steps, methods_of_fixed_steps(),
                     method) {
  constexpr double h = 1. / 50, t_end = 0.993;
  const Problem p = problem_for(method);
  const Run alone = run(method, p, t_end, {.step_size = h});
  std::vector<double> seen;
  const Observer observer{one_a_step(h, t_end), [&](const State& s) { seen.push_back(s.t); }};
  const Run watched = run(method, p, t_end, {.step_size = h}, observer);
  BOOST_TEST(watched.summary.message == "");
  BOOST_TEST(same(watched.state, alone.state));
  BOOST_TEST(watched.summary.counts.steps == alone.summary.counts.steps);
  // The work of looking is told.
  BOOST_TEST(watched.summary.counts.force_evaluations > alone.summary.counts.force_evaluations);
  BOOST_TEST(seen == observer.times, boost::test_tools::per_element());
  // To look at the ends of steps costs nothing.
  Film film{{0.26, 0.5}};
  const Run at_ends = run(method, p, t_end, {.step_size = h}, film.observer());
  BOOST_TEST(same(at_ends.state, alone.state));
  BOOST_TEST(at_ends.summary.counts == alone.summary.counts);
}

BOOST_DATA_TEST_CASE(what_is_seen_between_steps_has_the_order_of_the_method,
                     methods_of_fixed_steps(), method) {
  const std::vector<double> times = {0.1131, 0.2718, 0.3703, 0.5772, golden, 0.7744, 0.9821};
  if (method.order == 0) return;
  const Problem p = problem_for(method);
  Film exact{times};
  run(method_named("kahan_li8"), p, 1, {.step_size = 1. / 512}, exact.observer());
  // The largest error at all looks. The first steps are so long that errors of orders above 5
  // stay above rounding. Multistep methods of order 8 and 10 begin with 7 and 9 steps of another
  // kind.
  std::vector<double> errors;
  const bool is_long = method.recurrence_roots && method.order >= 8;
  const int first = is_long             ? 24
                    : method.order > 8  ? 4
                    : method.order > 5  ? 12
                    : method.order == 1 ? 160
                                        : 40;
  for (const int steps : {first, 2 * first, 4 * first}) {
    double error = 0;
    std::size_t i = 0;
    const Observer observer{
        times, [&](const State& s) { error = std::max(error, distance(s, exact.seen[i++])); }};
    const Run r = run(method, p, 1, {.step_size = 1. / steps}, observer);
    BOOST_TEST(r.summary.message == "", method.name << ": " << r.summary.message);
    errors.push_back(error);
  }
  // Two halvings; places in the steps differ from one to the next.
  const double order = std::log2(errors.front() / errors.back()) / 2;
  BOOST_TEST(order > method.order - 0.4, method.name << ": " << order);
}

BOOST_DATA_TEST_CASE(the_state_is_that_of_its_time_however_little_parts_it_from_whole_steps,
                     methods_of_fixed_steps(), method) {
  const Problem p = flight();
  // Ends up to 1e-6 h before and behind a whole number of steps of 0.1, and beyond that.
  for (const double beside : {-9e-7, -1e-8, 1e-10, 1e-8, 9e-7, 2e-6, -2e-6, 0.3}) {
    BOOST_TEST_CONTEXT(method.name << " " << beside) {
      const double t_end = 1 + 0.1 * beside;
      std::vector<double> times;
      for (int i = 1; i < 10; ++i) times.push_back(i * t_end / 10);
      const Observer observer{times, [](const State& s) {
                                // Steps round by an eps of x each, v = u/h more, and Newton's
                                // iteration of ARKODE's methods leaves some 1e-13.
                                BOOST_TEST(std::abs(s.q[0] - s.t) < 1e-12);
                                BOOST_TEST(std::abs(s.v[0] - 1) < 1e-12);
                              }};
      const Run r = run(method, p, t_end, {.step_size = 0.1}, observer);
      BOOST_TEST(r.summary.message == "");
      BOOST_TEST(r.state.t == t_end);
      BOOST_TEST(std::abs(r.state.q[0] - t_end) < 1e-12);
      BOOST_TEST(r.summary.counts.steps == (beside > 1e-6 ? 11 : 10));
    }
  }
}

BOOST_DATA_TEST_CASE(without_forces_every_method_flies_exactly, general_methods(), method) {
  const Problem p{{.dimension = 3, .node_mass = Vec{{1, 3}}},
                  {0, Vec::LinSpaced(6, -1, 1), Vec::LinSpaced(6, 2, -3)}};
  const Run r = run(method, p, 1.03, options_of(method, 0.1, 1e-6));
  BOOST_TEST(r.summary.message == "");
  // Rounding of at most some hundred steps or stages.
  BOOST_TEST(distance(r.state.v, p.initial.v) < 1e-13);
  BOOST_TEST(distance(r.state.q, p.initial.q + 1.03 * p.initial.v) < 1e-13);
}

BOOST_DATA_TEST_CASE(a_state_between_steps_is_kept_where_the_next_step_fails,
                     methods_of(Family::hand_written, Knob::step_size), method) {
  Problem p = Oscillator{}.problem();
  const auto system = make_mass_spring(p.network);
  Relay relay(*system);
  bool fails = false;
  relay.after_force = [&](const ConstVec&, MutableVec) {
    if (fails) throw std::runtime_error("no more");
  };
  const auto begin_to_fail = [&](const State& s) { fails = s.t > 0.5; };
  const Run r = run(method, relay, p.initial, 1, {.step_size = 0.1}, {{0.25, 0.55}, begin_to_fail});
  if (method.asks(Need::laplacian) && r.summary.outcome == Outcome::reached_end) return;
  BOOST_TEST(r.thrown == "no more");
  // Some methods complete a state by evaluating the force at the start of the next step.
  // Multistep methods compute their first steps together: their next force is that of a later
  // step.
  BOOST_TEST(r.state.t == (method.recurrence_roots ? 0.1 * std::max(6, method.order) : 0.55));
}

BOOST_DATA_TEST_CASE(times_too_short_to_square_are_told_as_such, unconstrained_methods(), method) {
  const Problem p = problem_for(method);
  for (const double t_end : {1e-300, 1e-160}) {
    const Run r = run(method, p, t_end, options_of(method, 0.01, 1e-6));
    BOOST_TEST(name(r.summary.outcome) == "step_too_small");
    BOOST_TEST(r.summary.message.find("s to run are too short") != std::string::npos,
               r.summary.message);
    BOOST_TEST(same(r.state, p.initial));
  }
}

BOOST_AUTO_TEST_SUITE_END()
