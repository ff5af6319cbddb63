#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/kink_search.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(kinks)

using namespace qddot;

namespace {

// m x'' = -k (x - l0 sign x): a mass on a line that swings through the pin of its spring, from rest
// at x0 > 2 l0. It moves as x = l0 + (x0 - l0) cos w t until it reaches the pin at t1. After that
// x(t1 + s) = -x(t1 - s).
struct ThroughThePin {
  double k, m, l0, x0, origin = 0;

  double pass() const { return std::acos(-l0 / (x0 - l0)) / std::sqrt(k / m); }
  double position(double t) const {
    double sign = 1;
    for (; t > 2 * pass(); t -= 2 * pass()) sign = -sign;
    if (t > pass()) {
      t = 2 * pass() - t;
      sign = -sign;
    }
    return origin + sign * (l0 + (x0 - l0) * std::cos(std::sqrt(k / m) * t));
  }
  Problem problem() const {
    Problem p{{.dimension = 1, .node_mass = Vec::Constant(1, m)}, {}};
    p.network.anchors = {{0, {origin, 0, 0}, {k, l0}}};
    p.initial = {0, Vec::Constant(1, origin + x0), Vec::Zero(1)};
    return p;
  }
};

ThroughThePin random_one(std::mt19937& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const double l0 = uniform(0.2, 1);
  return {std::pow(10, uniform(1, 4)), uniform(0.5, 2), l0, l0 * uniform(2.1, 4)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(errors_follow_the_tolerance_through_jumps_of_the_force) {
  std::mt19937 random(20);
  for (int trial = 0; trial < 20; ++trial) {
    const ThroughThePin exact = random_one(random);
    const double until = 5.3 * exact.pass();  // three jumps
    for (const char* method : {"dprkn6", "dprkn8", "dprkn12", "rodas4"}) {
      const bool is_low = method_named(method).order == 4;
      for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13}) {
        if (is_low && rtol < 1e-8) continue;
        BOOST_TEST_CONTEXT(method << " at " << rtol << " in trial " << trial) {
          // States between steps are as accurate as the steps.
          Film film{{0.97 * exact.pass(), 1.001 * exact.pass(), 3.5 * exact.pass()}};
          const Options options{
              .rtol = rtol, .length = exact.x0, .speed = exact.x0 * std::sqrt(exact.k / exact.m)};
          const Run r = run(method_named(method), exact.problem(), until, options, film.observer());
          BOOST_TEST(r.summary.message == "");
          film.seen.push_back(r.state);
          for (const State& s : film.seen) {
            // As on smooth motions of a few periods; and some 100 roundings of steps and times.
            const double most = is_low ? 1000 * rtol : 10 * rtol + 1e-13;
            BOOST_TEST(std::abs(s.q[0] - exact.position(s.t)) < most * exact.x0);
          }
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(far_from_the_origin_where_a_length_stays_zero_for_many_roundings_it_goes_on) {
  const ThroughThePin exact{400, 1, 0.5, 1.75, 1e6};
  const Run r = run(method_named("dprkn8"), exact.problem(), 5.3 * exact.pass(),
                    {.rtol = 1e-8, .length = 1, .speed = 30});
  BOOST_TEST(r.summary.message == "");
  // Positions are rounded by 1e-10 m at each of some hundred steps.
  BOOST_TEST(std::abs(r.state.q[0] - exact.position(r.state.t)) < 1e-6);
}

BOOST_AUTO_TEST_CASE(the_first_change_of_sign_is_found_where_the_ends_show_none) {
  const ThroughThePin scene{400, 1, 0.5, 1.7};
  const auto system = make_mass_spring(scene.problem().network);
  KinkSearch search(*system);
  BOOST_TEST(search.has_kinks());
  const auto at = [](double t, double x, double v) {
    return State{t, Vec::Constant(1, x), Vec::Constant(1, v)};
  };
  // x = (t - 0.3) (t - 0.6), which a cubic polynomial follows.
  const auto twice = search.first(at(0, 0.18, -0.9), at(1, 0.28, 1.1));
  BOOST_TEST_REQUIRE(twice.has_value());
  BOOST_TEST(std::abs(twice->part - 0.3) < 1e-14);
  const auto once = search.first(at(2, 1, -4), at(2.5, -1, -4));
  BOOST_TEST_REQUIRE(once.has_value());
  BOOST_TEST(std::abs(once->part - 0.5) < 1e-14);
  BOOST_TEST(!search.first(at(0, 1, -1), at(1, 0.5, -0.1)));
  BOOST_TEST(search.first(at(0, 0, 1), at(1, 1, 1))->part == 0);
  BOOST_TEST(!search.first(at(0, 0, 0), at(1, 0, 0)));
  // Springs of rest length zero, and those in a plane, have none.
  BOOST_TEST(!KinkSearch(*make_mass_spring(Oscillator().problem().network)).has_kinks());
  BOOST_TEST(!KinkSearch(*make_mass_spring(hammock(2).network)).has_kinks());
}

BOOST_AUTO_TEST_CASE(where_springs_turn_that_should_not_a_run_goes_on_as_drawn) {
  // Three masses in a row between two points, so fast that springs turn over and back.
  Problem p{{.dimension = 1, .node_mass = Vec::Constant(3, 1)},
            {0, Vec{{1, 2, 3}}, Vec{{12, -9, 4}}}};
  p.network.anchors = {{0, {0, 0, 0}, {50, 0.9}}, {2, {4, 0, 0}, {50, 0.9}}};
  p.network.links = {{0, 1, {50, 0.9}}, {1, 2, {50, 0.9}}};
  const Problem drawn = p;
  p.network.anchors[0].direction = -1;
  for (auto* spring : {&p.network.links[0], &p.network.links[1]}) spring->direction = 1;
  p.network.anchors[1].direction = 1;
  const auto directed = make_mass_spring(p.network);
  BOOST_TEST(directed->stiffness_is_constant());
  bool has_turned = false;
  for (const Method& method : methods_of(Knob::step_size)) {
    BOOST_TEST_CONTEXT(method.name) {
      const Options options{.step_size = 0.01, .solve_tolerance = 1e-12};
      for (const double until : {0.05, 0.2, 0.3}) {
        const Run a = run(method, drawn, until, options);
        const Run b = run(method, *directed, p.initial, until, options);
        BOOST_TEST(a.summary.message == "");
        BOOST_TEST(b.summary.message == "");
        has_turned = has_turned || !is_linear_at(*directed, b.state.q);
        // A hundred steps solve to 1e-12 of a step's 0.1 m, and a force that jumps by 45 N enlarges
        // these errors. A spring taken as if it had not turned gives errors of metres.
        BOOST_TEST(distance(a.state, b.state) < 1e-7);
      }
    }
  }
  BOOST_TEST(has_turned);
}

BOOST_DATA_TEST_CASE(a_spring_that_turns_over_and_back_keeps_its_law, methods_of(Knob::step_size),
                     method) {
  // A mass that swings through its anchor, so that steps begin on either side and end on either.
  Problem p{{.dimension = 1, .node_mass = Vec::Constant(1, 1.0)},
            {0, Vec::Constant(1, 0.9), Vec::Constant(1, 8.0)}};
  p.network.anchors = {{0, {0, 0, 0}, {50, 0.9}}};
  const auto drawn = make_mass_spring(p.network);
  p.network.anchors[0].direction = 1;
  for (const double h : {0.01, 0.013, 0.017, 0.023, 0.03}) {
    BOOST_TEST_CONTEXT(method.name << " at " << h) {
      const Options options{.step_size = h, .solve_tolerance = 1e-12};
      const Run a = run(method, *drawn, p.initial, 3, options);
      const Run b = run(method, p, 3, options);
      BOOST_TEST((a.summary.outcome == b.summary.outcome));
      // As above; one mass that crosses twice a swing does not magnify it.
      BOOST_TEST(distance(a.state, b.state) < 1e-7);
      if (method.name != "discrete_gradient") continue;
      // Some hundred solves to 1e-12 of a step, each of less than the energy.
      const double energy = total_energy(*drawn, p.initial);
      BOOST_TEST(std::abs(total_energy(*drawn, a.state) / energy - 1) < 1e-10);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
