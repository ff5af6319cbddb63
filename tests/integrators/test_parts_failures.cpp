#include <algorithm>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/growth.hpp"
#include "tests/integrators/parts.hpp"

BOOST_AUTO_TEST_SUITE(parts_failures)

using namespace qddot;

namespace {

constexpr double t_end = start_time + 0.9;
Options options_for(const Method& method) {
  Options options = options_of(method, 0.01, 1e-6);
  options.solve_tolerance = 1e-12;
  return options;
}
const Observer early{{start_time + 0.05}, [](const State&) {}};

// Checks that two states are equal to the last bit. There are exceptions if a method had to go back
// to an observer's time:
// - An adaptive method chooses its steps by its start and end, and agrees to its tolerance of 1e-6.
// - A method whose iterations start from the last steps agrees to their tolerances in 100 steps.
// - A method that interpolates does so at the end of the others, where it alone ends a step.
// - A method that remembers steps starts again at the earlier time.
void check_same(const Method& method, const State& a, const State& b, bool to_the_bit) {
  BOOST_TEST(a.t == b.t);
  const bool remembers =
      method.family == Family::sundials || method.listens_to(Option::solve_tolerance);
  const bool starts_anew = method.is(Trait::remembers_steps);
  if (!method.is(Trait::interpolates) && (to_the_bit || !(remembers || starts_anew))) {
    BOOST_TEST(same(a, b));
  } else {
    BOOST_TEST(distance(a, b) < (method.knob == Knob::rtol || starts_anew ? 0.1 : 1e-8));
  }
}

// Runs `bad` among other parts, at each place, with and without an observer that looks in before.
// All must end at the time that `bad` reaches alone, each in its own state at that time.
void check_failure(const Method& method, const Part& bad, Outcome outcome) {
  const std::vector<Part> good = parts_for(method);
  const Options options = options_for(method);
  for (const Observer& observer : {Observer{}, early}) {
    const Run alone = run(method, bad, t_end, options, observer);
    BOOST_TEST(name(alone.summary.outcome) == name(outcome));
    BOOST_TEST(alone.state.t > start_time + 0.05);
    BOOST_TEST(alone.state.t < t_end);
    for (std::size_t place = 0; place <= good.size(); ++place) {
      BOOST_TEST_CONTEXT(method.name << ", place " << place << ", " << observer.times.size()) {
        std::vector<Part> parts = good;
        parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(place), bad);
        const Together together(parts);
        const Run r = run(method, together, t_end, options, observer);
        BOOST_TEST(name(r.summary.outcome) == name(outcome));
        BOOST_TEST(r.thrown == alone.thrown);
        if (r.thrown.empty()) BOOST_TEST(r.summary.message == alone.summary.message);
        BOOST_TEST(r.state.t == alone.state.t);
        BOOST_TEST(r.summary.t_reached == r.state.t);
        BOOST_TEST(same(together.part(r.state, place), alone.state));
        for (std::size_t i = 0; i < parts.size(); ++i) {
          if (i == place) continue;
          const Run own = run(method, parts[i], r.state.t, options, observer);
          check_same(method, together.part(r.state, i), own.state, observer.times.empty());
        }
      }
    }
  }
}

// A mass that swings back on a spring which may not be compressed, after a quarter of a period.
Part string(double quarter_period) {
  const double omega = M_PI / (2 * quarter_period);
  Problem p{{.dimension = 1, .node_mass = Vec::Ones(1)}, {0, Vec{{1.5}}, Vec::Zero(1)}};
  p.network.anchors = {{0, {0, 0, 0}, {omega * omega, 1}, Holds::in_tension}};
  return part(p);
}

}  // namespace

BOOST_DATA_TEST_CASE(a_part_that_diverges_ends_the_run_of_all_at_its_last_step,
                     methods_of(Knob::step_size), method) {
  if (method.is(Trait::implicit)) return;
  // Steps are 1/100 s; explicit Euler has no limit and grows threefold a step at h w = 3. A step of
  // many stages grows by far more soon above its limit, and a few steps are to be seen before the
  // end. Some splittings are stable in places far beyond their limit. Multistep methods compute
  // their first steps together, which are not to diverge already.
  const double limit = method.recurrence_roots ? *method.stability_limit
                                               : std::max(2.0, method.stability_limit.value_or(2));
  double h_omega = method.recurrence_roots ? 2 * limit : 1.1 * limit;
  while (!method.recurrence_roots && growth_a_step(method, h_omega) < 3) h_omega *= 1.1;
  const double omega = 100 * h_omega;
  check_failure(method, part(Oscillator{.mass = 1, .stiffness = omega * omega}.problem()),
                Outcome::diverged);
}

BOOST_DATA_TEST_CASE(a_part_that_throws_ends_the_run_of_all_at_its_last_step,
                     unconstrained_methods(), method) {
  if (method.asks(Need::split_forces)) return;  // which the part that gives up has not
  check_failure(method, giving_up(-0.2, "no more"), Outcome::solver_failed);
}

BOOST_DATA_TEST_CASE(a_part_that_goes_slack_ends_the_run_of_all_at_its_last_step, general_methods(),
                     method) {
  check_failure(method, string(0.3), Outcome::went_slack);
}

BOOST_DATA_TEST_CASE(of_several_parts_that_fail_the_earliest_decides_in_any_order,
                     general_methods(), method) {
  if (method.order >= 12) return;  // whose steps are longer than failures are apart
  // They evaluate forces where they end, for the velocity there, or beside it.
  if (method.recurrence_roots) return;
  const std::vector<Part> bad = {string(0.4), giving_up(-0.5, "late"), giving_up(0.2, "early"),
                                 part(hammock(2))};
  const Run first = run(method, bad[2], t_end, options_for(method));
  BOOST_TEST(first.thrown == "early");
  std::vector<std::size_t> order = {0, 1, 2, 3};
  do {
    BOOST_TEST_CONTEXT(method.name << " " << order[0] << order[1] << order[2] << order[3]) {
      std::vector<Part> parts;
      for (const std::size_t i : order) parts.push_back(bad[i]);
      const Together together(parts);
      const Run r = run(method, together, t_end, options_for(method));
      BOOST_TEST(r.thrown == "early");
      // The last step of an adaptive method depends on the requested end.
      if (method.knob == Knob::step_size) BOOST_TEST(r.state.t == first.state.t);
      BOOST_TEST(std::abs(r.state.t - first.state.t) < 0.05);
      BOOST_TEST(r.summary.t_reached == r.state.t);
      for (std::size_t i = 0; i < order.size(); ++i) {
        const Run own = run(method, parts[i], r.state.t, options_for(method));
        BOOST_TEST(own.summary.message == "");
        check_same(method, together.part(r.state, i), own.state, false);
      }
    }
  } while (std::ranges::next_permutation(order).found);
}

BOOST_DATA_TEST_CASE(a_step_that_no_part_can_take_is_refused_for_all, methods_of(Knob::step_size),
                     method) {
  const Together together(parts_for(method));
  const Run r = run(method, together, t_end, {.step_size = 1e-20});
  BOOST_TEST(name(r.summary.outcome) == "step_too_small");
  BOOST_TEST(r.summary.message == advice(Outcome::step_too_small));
  BOOST_TEST(same(r.state, together.start));
}

BOOST_DATA_TEST_CASE(a_run_out_of_time_ends_where_all_parts_last_were_together,
                     unconstrained_methods(), method) {
  if (method.asks(Need::split_forces)) return;  // which the relay of the last straw has not
  for (std::size_t place = 0; place < 4; ++place) {
    BOOST_TEST_CONTEXT(method.name << ", place " << place) {
      std::stop_source budget;
      // Asks to stop at a force well after the observer's time, whatever the steps.
      const Part last_straw = watched_oscillator([&](const ConstVec& q, MutableVec) {
        if (q[0] <= -0.2) budget.request_stop();
      });
      std::vector<Part> parts = parts_for(method);
      parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(place), last_straw);
      const Together together(parts);
      Film film{{start_time + 0.05}};
      const Run r =
          run(method, together, t_end, options_for(method), film.observer(), budget.get_token());
      BOOST_TEST(name(r.summary.outcome) == "over_budget");
      BOOST_TEST(r.summary.message == advice(Outcome::over_budget));
      BOOST_TEST_REQUIRE(film.seen.size() == 1u);
      BOOST_TEST(film.seen[0].t == start_time + 0.05);
      BOOST_TEST(r.summary.t_reached == start_time + 0.05);
      BOOST_TEST(same(r.state, film.seen[0]));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
