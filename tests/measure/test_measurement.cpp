#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/front_again.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/measure/clocks.hpp"

BOOST_AUTO_TEST_SUITE(measurement)

using namespace qddot;

namespace {

constexpr double until = 0.5;

const Model& orbit() {
  static const Model scene(load_scene("orbit"));
  return scene;
}

const Reference& reference() {
  static const Reference made = make_reference(orbit(), until, 100);
  return made;
}

// Stays where it is. Its runs are counted.
class Still : public Formula {
 public:
  using Formula::Formula;
  static inline int runs = 0;

  void begin(const State& state, State& x) {
    x = state;
    ++runs;
  }
  Outcome step(const State& now, double, State& next) {
    next.q = now.q;
    next.v = now.v;
    return Outcome::reached_end;
  }
};

// A run takes more than a tenth of a second, and so does making the method.
class Slow final : public Still {
 public:
  explicit Slow(SystemRun& run) : Still(run) { MadeClock::pass(0.101); }
  void begin(const State& state, State& x) {
    Still::begin(state, x);
    MadeClock::pass(0.101);
  }
};

// A run takes 0.2 s, times the next of `left` while there are any.
class Uneven final : public Still {
 public:
  using Still::Still;
  void begin(const State& state, State& x) {
    Still::begin(state, x);
    MadeClock::pass(left.empty() ? 0.2 : 0.2 * left.front());
    if (!left.empty()) left.erase(left.begin());
  }
  static inline std::vector<double> left{};
};

// All runs but the first one fail.
class Once final : public Still {
 public:
  using Still::Still;
  Outcome step(const State& now, double h, State& next) {
    Still::step(now, h, next);
    return runs == 1 ? Outcome::reached_end : Outcome::newton_failed;
  }
};

template <class Made>
Method made_of() {
  Method method = *find_method("verlet");
  method.make = create<Made>;
  return method;
}

Point measured(const char* method, double value, const Effort& effort) {
  return measure_point(*find_method(method), value, orbit(), until, reference(), effort);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_knob_is_the_one_that_the_method_takes) {
  for (const Method& method : methods()) {
    const Options options = options_for(method, 0.25, orbit());
    const bool fixed = method.knob == Knob::step_size;
    BOOST_TEST(options.step_size == (fixed ? 0.25 : 0), method.name);
    BOOST_TEST(options.rtol == (fixed ? 0 : 0.25), method.name);
    BOOST_TEST(options.atol == 0, method.name);
  }
}

BOOST_AUTO_TEST_CASE(a_point_is_one_run_of_the_method) {
  for (const auto& [name, value] :
       {std::pair("verlet", 1e-2), std::pair("implicit_euler", 1e-3), std::pair("ida", 1e-5)}) {
    const Point point = measured(name, value, {.seconds = 60, .repeats = 2});
    const auto integrator = make_integrator(*find_method(name), orbit().system(),
                                            options_for(*find_method(name), value, orbit()));
    State state = orbit().initial();
    const Summary summary = integrator->advance(state, until);
    const Errors errors =
        errors_between(orbit(), state, reference().end, reference().energy, reference().scales);
    BOOST_TEST((point.outcome == Outcome::reached_end));
    BOOST_TEST(point.t_reached == until);
    BOOST_TEST(point.errors.position == errors.position);
    BOOST_TEST(point.errors.velocity == errors.velocity);
    BOOST_TEST(point.errors.energy == errors.energy);
    BOOST_TEST(point.errors.position > 0);
    BOOST_TEST((point.counts == summary.counts));
  }
}

// By a made clock: beside other programs times vary, and are then taken more often.
BOOST_AUTO_TEST_CASE(it_is_timed_as_often_as_asked_for) {
  const MadeClock clock;
  for (const int repeats : {1, 2, 5}) {
    const Point point = measure_point(made_of<Slow>(), until, orbit(), until, reference(),
                                      {.seconds = 60, .repeats = repeats});
    BOOST_TEST(point.timed_runs == repeats);
    BOOST_TEST(point.time_min > 0);
    BOOST_TEST(point.time_min <= point.time);
    BOOST_TEST(point.setup > 0);
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_fails_is_not_timed) {
  const Point slow = measured("verlet", 1e-12, {.seconds = 0.01, .repeats = 3});
  BOOST_TEST((slow.outcome == Outcome::over_budget));
  BOOST_TEST(slow.t_reached < until);
  BOOST_TEST(slow.timed_runs == 0);
  BOOST_TEST(slow.time == 0);
  BOOST_TEST(std::isnan(slow.errors.position));
  const Point stuck = measured("verlet", 1e-20, {.seconds = 60, .repeats = 3});
  BOOST_TEST((stuck.outcome == Outcome::step_too_small));
  BOOST_TEST(stuck.timed_runs == 0);
}

BOOST_AUTO_TEST_CASE(a_repeat_that_fails_is_a_failure_and_not_a_short_run) {
  Still::runs = 0;
  const Point point = measure_point(made_of<Once>(), until, orbit(), until, reference(),
                                    {.seconds = 60, .repeats = 3});
  BOOST_TEST((point.outcome == Outcome::newton_failed));
  BOOST_TEST(point.t_reached == 0);
  BOOST_TEST(point.timed_runs == 0);
  BOOST_TEST(std::isnan(point.errors.position));
}

BOOST_AUTO_TEST_CASE(only_a_long_run_is_its_own_warm_up) {
  const MadeClock clock;
  for (const int repeats : {1, 2}) {
    const Effort effort{.seconds = 60, .repeats = repeats};
    Slow::runs = 0;
    BOOST_TEST(
        measure_point(made_of<Slow>(), until, orbit(), until, reference(), effort).timed_runs ==
        repeats);
    BOOST_TEST(Slow::runs == repeats);
    Still::runs = 0;
    BOOST_TEST(
        measure_point(made_of<Still>(), until, orbit(), until, reference(), effort).timed_runs ==
        repeats);
    BOOST_TEST(Still::runs > repeats);
  }
}

BOOST_AUTO_TEST_CASE(times_that_vary_are_taken_more_often) {
  const MadeClock clock;
  // Three of the first five runs are twice as long as all later ones.
  const auto taken = [](std::vector<double> lengths) {
    Uneven::left = std::move(lengths);
    return measure_point(made_of<Uneven>(), until, orbit(), until, reference(),
                         {.seconds = 60, .repeats = 5});
  };
  const Point steady = taken({});
  BOOST_TEST(steady.timed_runs == 5);
  BOOST_TEST(!is_disturbed(steady));
  const Point short_burst = taken({2, 2, 2, 1});
  BOOST_TEST(short_burst.timed_runs == 7);  // then four of seven are as short as the least
  BOOST_TEST(short_burst.time == 0.2, boost::test_tools::tolerance(1e-6));
  const Point long_burst = taken({1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2});
  BOOST_TEST(long_burst.timed_runs == 15);
  BOOST_TEST(is_disturbed(long_burst));
  BOOST_TEST(long_burst.time == 2 * long_burst.time_min, boost::test_tools::tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(what_decides_a_chart_is_timed_again_and_the_smaller_median_counts) {
  const auto point = [](const char* name, double error, double time, double least) {
    return Point{.method = find_method(name),
                 .value = 0.1,
                 .outcome = Outcome::reached_end,
                 .errors = {.position = error, .velocity = 0, .energy = 0},
                 .time = time,
                 .time_min = least,
                 .timed_runs = 5};
  };
  Reference known;
  known.end.t = 2;
  known.certified = {.position = 1e-12, .velocity = 1e-12, .energy = 1e-12};
  // The second would win without what disturbed it, the third would not, and the fourth is coarse.
  std::vector<Point> points = {point("verlet", 1e-4, 1, 0.95), point("symmetric6", 1e-4, 3, 0.9),
                               point("rk4", 1e-4, 3, 2.5), point("ida", 0.5, 0.1, 0.1)};
  std::vector<std::string> taken;
  const auto again = time_front_again(points, known, {1e-3}, [&](const Point& first) {
    taken.push_back(first.method->name);
    Point second = first;
    second.time = second.time_min = first.method->name == "verlet" ? 1.1 : 0.8;
    return second;
  });
  std::ranges::sort(taken);
  BOOST_TEST(taken == (std::vector<std::string>{"symmetric6", "verlet"}),
             boost::test_tools::per_element());
  take_smaller_times(points, again);
  BOOST_TEST(points[0].time == 1);
  BOOST_TEST(points[1].time == 0.8);
  BOOST_TEST(points[1].timed_runs == 10);
  BOOST_TEST(points[2].time == 3);
  BOOST_TEST(fastest_at_each_accuracy(points, known, {1e-3})[0].fastest == &points[1]);
}

BOOST_AUTO_TEST_SUITE_END()
