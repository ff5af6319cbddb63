#include <array>
#include <utility>

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

// The same with a spring of stiffness k + quartic c: m u'' = -(k u + c u^3), u = x - l0 while x >
// 0. Taylor series in long double, of the same symmetries.
struct SlowPass {
  long double k, c, m, l0, x0;
  struct Place {
    long double x, v;
  };

  // Coefficients of u after a place; terms beyond the last are below 1e-20 in steps of step().
  std::array<long double, 24> series(const Place& at) const {
    std::array<long double, 24> u{at.x - l0, at.v}, square{}, cube{};
    for (std::size_t i = 0; i + 2 < u.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) square[i] += u[j] * u[i - j];
      for (std::size_t j = 0; j <= i; ++j) cube[i] += u[j] * square[i - j];
      const auto n = static_cast<long double>(i);
      u[i + 2] = -(k * u[i] + c * cube[i]) / m / ((n + 1) * (n + 2));
    }
    return u;
  }
  Place after(const Place& at, long double t) const {
    const auto u = series(at);
    Place there{0, 0};
    for (std::size_t i = u.size(); i-- > 0;) {
      there.v = there.v * t + there.x;
      there.x = there.x * t + u[i];
    }
    return {there.x + l0, there.v};
  }
  long double step() const { return 0.05L / std::sqrt((k + 3 * c * x0 * x0) / m); }
  // The first time at which it reaches the pin, or at which it turns before.
  std::pair<long double, bool> pass() const {
    Place at{x0, 0};
    for (long double t = 0;; t += step()) {
      const Place next = after(at, step());
      if (next.x > 0 && next.v < 0) {
        at = next;
        continue;
      }
      // The last time up to `high` at which it has not turned, or is not through.
      const auto last = [&](bool turn, long double high) {
        long double low = turn && t == 0 ? step() / 1024 : 0;
        for (int i = 0; i < 80; ++i) {
          const long double middle = (low + high) / 2;
          const Place place = after(at, middle);
          ((turn ? place.v < 0 : place.x > 0) ? low : high) = middle;
        }
        return low;
      };
      const long double turn = next.v < 0 ? step() : last(true, step());
      const bool passes = after(at, turn).x < 0;
      return {t + (passes ? last(false, turn) : turn), passes};
    }
  }
  double position(double time) const {
    const auto [half, passes] = pass();
    long double t = time, sign = 1;
    // It is at rest at x0 after two passes on the other side, or after a turn on this one.
    for (; t > 2 * half; t -= 2 * half) sign = passes ? -sign : sign;
    if (t > half) {
      t = 2 * half - t;
      if (passes) sign = -sign;
    }
    Place at{x0, 0};
    for (; t > step(); t -= step()) at = after(at, step());
    return static_cast<double>(sign * after(at, t).x);
  }
  // How far it is from the pin where it turns, or would turn without the jump of the force.
  double depth() const {
    const auto at = [&](long double x) { return k / 2 * x * x + c / 4 * x * x * x * x; };
    const long double excess = at(x0 - l0) - at(-l0);
    return static_cast<double>(std::abs(excess) / (k * l0 + c * l0 * l0 * l0));
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(slow_passes_and_near_turns_are_told_apart_or_the_run_says_that_it_cannot) {
  std::mt19937 random(2097);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  int reached = 0, told = 0;
  for (int trial = 0; trial < 150; ++trial) {
    SlowPass exact{std::pow(10, uniform(0.5, 2.5)), std::pow(10, uniform(0.5, 3)), uniform(0.1, 3),
                   uniform(0.3, 1), 0};
    if (trial % 3 == 0) exact.c = 0;
    if (trial % 3 == 1) exact.k = 0;
    // At 2 l0 it would come to rest at the pin.
    const double margin = std::pow(10, uniform(-8, -0.5));
    exact.x0 = 2 * exact.l0 * (trial % 2 == 0 ? 1 + margin : 1 - margin);
    const auto start = static_cast<double>(exact.x0), length = start;
    const auto rate = static_cast<double>(1 / (20 * exact.step()));
    const auto until = static_cast<double>(5.3L * exact.pass().first);
    const double position = exact.position(until), depth = exact.depth();
    Problem p{{.dimension = 1, .node_mass = Vec{{static_cast<double>(exact.m)}}},
              {0, Vec{{start}}, Vec{{0}}}};
    p.network.anchors = {{0,
                          {0, 0, 0},
                          {.stiffness = static_cast<double>(exact.k),
                           .rest_length = static_cast<double>(exact.l0),
                           .quartic = static_cast<double>(exact.c)}}};
    for (const char* method : {"dprkn6", "dprkn8", "dprkn12", "rodas4"}) {
      for (const double rtol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12}) {
        const bool is_low = method_named(method).order == 4;
        // Errors of order 4 add up to tens of coarse tolerances.
        if (is_low && (rtol < 1e-8 || rtol > 1e-6)) continue;
        BOOST_TEST_CONTEXT(method << " at " << rtol << " in trial " << trial << ", depth "
                                  << depth) {
          const Options options{.rtol = rtol, .length = length, .speed = length * rate};
          const Run r = run(method_named(method), p, until, options);
          if (r.summary.outcome != Outcome::reached_end) {
            BOOST_TEST(r.summary.message.find("whether it turns over or back is not known") !=
                       std::string::npos);
            // Ways that part within the tolerance, but for errors that have added up.
            BOOST_TEST(depth < 100 * rtol * length);
            ++told;
            continue;
          }
          // An error e of the depth changes the time of a pass by e/v, v = sqrt(2 a depth), so
          // that positions err by some e sqrt(length/depth) a pass. On the wrong way they err by
          // more than a quarter of the length.
          const double error = (100 * rtol + 1e-13) * std::sqrt(length / depth);
          BOOST_TEST(std::abs(r.state.q[0] - position) < std::min(error, 0.25) * length);
          ++reached;
        }
      }
    }
  }
  BOOST_TEST(reached > 3 * told);
  BOOST_TEST(told > 0);
}

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

BOOST_AUTO_TEST_CASE(a_change_of_sign_is_found_and_one_that_may_be_is_told) {
  const ThroughThePin scene{400, 1, 0.5, 1.7};
  const auto system = make_mass_spring(scene.problem().network);
  KinkSearch search(*system);
  BOOST_TEST(search.has_kinks());
  const auto at = [](double t, double x, double v, double a) {
    return Instant{{t, Vec::Constant(1, x), Vec::Constant(1, v)}, Vec::Constant(1, a)};
  };
  const auto once = search.first(at(2, 1, -4, 0), at(2.5, -1, -4, 0));
  BOOST_TEST_REQUIRE(once.has_value());
  BOOST_TEST(once->is_certain);
  BOOST_TEST(std::abs(once->part - 0.5) < 1e-14);
  BOOST_TEST(!search.first(at(0, 1, -1, 0), at(1, 0.5, -0.1, 1)));
  BOOST_TEST(search.first(at(0, 0, 1, 0), at(1, 1, 1, 0))->part == 0);
  BOOST_TEST(!search.first(at(0, 0, 0, 0), at(1, 0, 0, 0)));
  // Lengths (t - 0.55)^2 + gap of one sign at both ends. The polynomials follow them.
  for (const double gap : {-0.02, -1e-9, 0., 1e-9, 1e-3}) {
    BOOST_TEST_CONTEXT("a gap of " << gap) {
      const auto turn = search.first(at(0, 0.3025 + gap, -1.1, 2), at(1, 0.2025 + gap, 0.9, 2));
      BOOST_TEST(turn.has_value() == (gap <= 0));
      if (!turn) continue;
      BOOST_TEST(!turn->is_certain);
      // Eight looks, and what lies between two of them.
      BOOST_TEST(std::abs(turn->part - 0.55) < 1. / 8);
      BOOST_TEST(turn->nearest < std::abs(gap) + 1. / 64);
    }
  }
  // 1.01 + sin w t, which no polynomial follows at w h = 4 pi: nothing is certain about it.
  const double w = 4 * M_PI;
  BOOST_TEST_REQUIRE(search.first(at(0, 1.01, w, 0), at(1, 1.01, w, 0)).has_value());
  BOOST_TEST(!search.first(at(0, 1.01, w, 0), at(1, 1.01, w, 0))->is_certain);
  // At 2 m/s towards zero against 4 m/s^2 it would turn 0.5 m beyond, if it were not driven away
  // there. If it is driven back on both sides, no ways part.
  BOOST_TEST(std::abs(search.depth(at(0, 0.1, -2, 4), at(0.1, -0.1, -2, -4)) - 0.5) < 1e-15);
  BOOST_TEST(std::abs(search.depth(at(0, -0.1, 2, -4), at(0.1, 0.1, 2, 4)) - 0.5) < 1e-15);
  BOOST_TEST(search.depth(at(0, 0.1, -2, 4), at(0.1, -0.1, -2, 4)) == INFINITY);
  BOOST_TEST(search.depth(at(0, 0.1, -2, 4), at(0.1, 0.1, 2, 4)) == INFINITY);
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
