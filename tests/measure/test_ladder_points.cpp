#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/judgement.hpp"
#include "qddot/measure/speed/ladder_points.hpp"
#include "qddot/scene/scene_file.hpp"

BOOST_AUTO_TEST_SUITE(ladder_points)

using namespace qddot;

namespace {

constexpr double reference_seconds = 100;  // more than any takes, also on a slow machine

// A scene with its reference.
struct Course {
  Model scene;
  double until;
  Reference reference;

  Course(const Scene& drawn, double horizon)
      : scene(drawn),
        until(horizon),
        reference(make_reference(scene, horizon, reference_seconds)) {}
  Course(const std::string& name, double horizon) : Course(load_scene(name), horizon) {}

  std::vector<Point> run(const char* method, const Effort& effort,
                         const std::function<bool(const Point&)>& is_last = {}) const {
    std::vector<double> reported;
    auto points = measure_ladder(
        *find_method(method), scene, until, reference, effort,
        [&](const Point& point) { reported.push_back(point.value); }, is_last);
    std::vector<double> values;
    for (const Point& point : points) {
      BOOST_TEST(point.method == find_method(method));
      values.push_back(point.value);
    }
    std::ranges::sort(reported, std::greater());
    BOOST_TEST(reported == values, boost::test_tools::per_element());
    return points;
  }
};

// Twenty seconds at w = 10 rad/s: above h w = 2 an explicit method overflows.
const Course& oscillator() {
  static const Course course("oscillator", 20);
  return course;
}

const Effort short_runs{.seconds = 0.1, .repeats = 1};
// Generous: a budget that ends no ladder here.
const Effort long_runs{.seconds = 60, .repeats = 1};

// A slow vibration of two masses joined by a spring 1e6 times stiffer.
Scene held() {
  Scene scene{.name = "held", .dimension = 1};
  scene.nodes = {
      {.pinned = true}, {.position = {1, 0, 0}, .mass = 1}, {.position = {2, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 1}}, {{1, 2}, {.stiffness = 1e6, .rest_length = 1}}};
  return scene;
}

bool reached(const Point& point) { return point.outcome == Outcome::reached_end; }
bool is_good(const Point& point) { return reached(point) && point.errors.position < 1; }

}  // namespace

BOOST_AUTO_TEST_CASE(it_starts_where_an_explicit_method_fails) {
  const auto points = oscillator().run("verlet", short_runs);
  BOOST_TEST_REQUIRE(points.size() > 3u);
  BOOST_TEST((points[0].outcome == Outcome::diverged));
  BOOST_TEST(points[0].value * 10 > 2);
  BOOST_TEST(points[1].value * 10 <= 4);  // the next one takes no less long
  BOOST_TEST(points[0].t_reached < oscillator().until);
  // Verlet's method is stable with 100 steps and no fewer. The coarsest good point has at most
  // 1/0.98 times as many; the next coarser one is as near, and not good.
  const auto good = std::ranges::find_if(points, is_good);
  BOOST_TEST_REQUIRE((points.end() - good > 3));
  BOOST_TEST(std::ranges::all_of(good, points.end() - 1, is_good));
  const double steps = std::round(20 / good->value), before = std::round(20 / (good - 1)->value);
  BOOST_TEST(steps >= 100);
  BOOST_TEST(steps <= 102);
  BOOST_TEST(before >= 0.98 * steps);
  // Half a period is too short for anything to overflow.
  for (const Point& point : Course("oscillator", 0.05).run("verlet", long_runs))
    BOOST_TEST(reached(point));
}

// Near their limit explicit steps are closer (see test_ladder.cpp), which has an end before 16
// times as many of them.
BOOST_AUTO_TEST_CASE(points_divide_the_expected_error_by_four) {
  for (const auto& [method, order, has_limit] :
       {std::tuple("implicit_euler", 1, false), std::tuple("implicit_midpoint", 2, false),
        std::tuple("verlet", 2, true), std::tuple("kahan_li8", 8, true)}) {
    const auto points = oscillator().run(method, short_runs);
    BOOST_TEST_REQUIRE(points.size() > 2u);
    const double coarsest = std::ranges::find_if(points, reached)->value;
    // Without a limit it starts a whole motion off.
    if (!has_limit) {
      BOOST_TEST(coarsest == points[0].value);
      BOOST_TEST((points[0].errors.position >= 1 || coarsest == oscillator().until));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double steps = oscillator().until / points[i].value;
      BOOST_TEST(std::abs(steps - std::round(steps)) < 1e-9 * steps);
      if (i == 0) continue;
      const double ratio = points[i - 1].value / points[i].value;
      const double off = ratio / std::pow(4, 1.0 / order) - 1;
      // The number of steps is whole, so the ratio is met but for 1/2 in each.
      const double rounding = 2 / (steps / ratio);
      BOOST_TEST(off < rounding, method << " at " << points[i].value << ": " << ratio);
      if (has_limit && points[i - 1].value > coarsest / 16) continue;
      BOOST_TEST(off > -rounding, method << " at " << points[i].value << ": " << ratio);
    }
  }
}

BOOST_AUTO_TEST_CASE(tolerances_go_by_powers_of_ten_from_a_tenth) {
  const Course course("pair", 0.2);
  for (const char* method : {"arkode_dirk4", "ida"}) {
    const auto points = course.run(method, short_runs);
    BOOST_TEST(points.size() > 5u);
    for (std::size_t i = 0; i < points.size(); ++i) {
      BOOST_TEST(points[i].value == std::pow(10, -1 - static_cast<double>(i)),
                 boost::test_tools::tolerance(1e-14));
    }
  }
}

BOOST_AUTO_TEST_CASE(it_ends_at_the_first_point_over_budget) {
  // An error of 1e-15 would take a first-order method 1e15 steps.
  for (const char* method : {"implicit_euler", "symplectic_euler"}) {
    const auto points = oscillator().run(method, short_runs);
    BOOST_TEST((points.back().outcome == Outcome::over_budget), method);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      BOOST_TEST((points[i].outcome != Outcome::over_budget), method << " point " << i);
    }
    const Point& last_good = points[points.size() - 2];
    BOOST_TEST(reached(last_good));
    BOOST_TEST(points.back().t_reached < oscillator().until);
  }
}

BOOST_AUTO_TEST_CASE(it_goes_down_to_where_the_reference_or_rounding_ends_it) {
  // Few steps of high order: neighbouring points round to the same number of steps, or do not
  // improve yet.
  for (const auto& [name, until] :
       {std::pair("orbit", 0.3), std::pair("pair", 0.1), std::pair("pendulum", 0.6)}) {
    const Course course(name, until);
    const auto points = course.run("kahan_li8", long_runs);
    BOOST_TEST(points.back().errors.position < 1e-11,
               name << " to " << until << " ended at " << points.back().errors.position);
  }
}

BOOST_AUTO_TEST_CASE(a_lucky_error_does_not_end_it) {
  // At h w = 10, where the error at the end passes through zero, they are within 0.1.
  const auto is_enough = [](const Point& point) { return point.errors.position < 0.1; };
  const Course course("oscillator", 2);
  for (const char* method : {"generalized_alpha", "hht"}) {
    const auto points = course.run(method, long_runs, is_enough);
    BOOST_TEST(is_enough(points[1]), method);
    BOOST_TEST(points[1].value == 1, method);
    BOOST_TEST(points.back().errors.position < 0.1, method);
    BOOST_TEST(points.back().value < 0.1, method);  // h w < 1
    BOOST_TEST(judged_together(points, course.reference, Quantity::position)[1].is_lucky, method);
  }
}

BOOST_AUTO_TEST_CASE(it_does_not_go_below_what_the_reference_certifies) {
  Course course("orbit", 0.3);
  course.reference.certified.position = 1e-4;
  const auto points = course.run("verlet", long_runs);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!reached(points[i])) continue;
    BOOST_TEST((points[i].errors.position <= 1e-4) == (i + 1 == points.size()), "point " << i);
  }
}

BOOST_AUTO_TEST_CASE(beyond_the_horizon_it_goes_down_by_the_energy_error) {
  Course course("orbit", 0.3);
  course.reference.certified.position = 0.1;  // as if nobody knew the end
  const auto blind = course.run("kahan_li8", long_runs);
  BOOST_TEST(blind.back().errors.position > 1e-9);
  course.reference.horizon = 0.2;
  const Watch watch(load_scene("orbit"), course.scene, course.until, course.reference);
  Effort watched = long_runs;
  watched.watch = &watch;
  const auto points = course.run("kahan_li8", watched);
  BOOST_TEST(points.back().path.energy < 1e-13);
  BOOST_TEST(points.size() > blind.size() + 3);
}

BOOST_AUTO_TEST_CASE(steps_held_to_a_stability_limit_do_not_end_it) {
  // Steps that are stable for the stiff spring are far finer than a coarse tolerance needs.
  const auto points = Course(held(), 1).run("arkode_erk4", long_runs);
  const auto is_held = [](const Point& point) {
    return 2 * point.counts.stability_limited_steps > point.counts.steps;
  };
  BOOST_TEST_REQUIRE(points.size() > 4u);
  // Four points of good errors without a gain would end the ladder of any other method.
  for (std::size_t i = 0; i < 4; ++i) {
    BOOST_TEST(is_held(points[i]));
    BOOST_TEST(points[i].errors.position < 1e-4);
    BOOST_TEST(points[i].errors.position > 0.8 * points[0].errors.position);
  }
  BOOST_TEST(!is_held(points.back()));
  BOOST_TEST(points.back().errors.position < 1e-4 * points[0].errors.position);
}

// A method that is implicit only in the stiff spring blows up if steps are too long for the soft
// one. The next smaller step is as near to that limit as for explicit methods.
BOOST_AUTO_TEST_CASE(implicit_steps_that_run_away_are_taken_closer_too) {
  Scene scene = held();
  scene.stiff_above = 1e3;
  // Ten times as soft is as good here, and its reference takes a tenth of the steps.
  scene.springs[1].law.stiffness = 1e4;
  constexpr double until = 200;
  const auto points =
      Course(scene, until).run("linear_midpoint", long_runs, [](const Point& point) {
        return point.errors.position < 1e-2;
      });
  BOOST_TEST_REQUIRE((points[0].outcome != Outcome::reached_end || points[0].errors.position > 1));
  const auto ran_away = [](const Point& point) { return point.outcome == Outcome::diverged; };
  BOOST_TEST(std::ranges::any_of(points, ran_away));
  const auto good = std::ranges::find_if(points, is_good);
  BOOST_TEST_REQUIRE((good != points.begin() && good != points.end()));
  const double before = std::round(until / (good - 1)->value),
               steps = std::round(until / good->value);
  BOOST_TEST((before >= 0.98 * steps || steps - before == 1), before << " and " << steps);
}

BOOST_AUTO_TEST_CASE(where_nothing_moves_one_point_is_enough) {
  Scene scene{.name = "rest"};
  scene.nodes = {{.mass = 1}};
  const Course at_rest(scene, 1);
  for (const char* name : {"verlet", "implicit_euler", "ida"}) {
    const auto points = at_rest.run(name, short_runs);
    BOOST_TEST(points.size() <= 2u, name << " took " << points.size());
    BOOST_TEST(points.back().errors.position == 0);
  }
}

BOOST_AUTO_TEST_CASE(nothing_finer_is_taken_than_what_is_enough) {
  const auto is_last = [](const Point& point) { return point.errors.position <= 1e-3; };
  const auto points = oscillator().run("verlet", long_runs, is_last);
  BOOST_TEST_REQUIRE(points.size() >= 2u);
  BOOST_TEST((reached(points.back()) && is_last(points.back())));
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    BOOST_TEST(!(reached(points[i]) && is_last(points[i])));
  }
}

BOOST_AUTO_TEST_SUITE_END()
