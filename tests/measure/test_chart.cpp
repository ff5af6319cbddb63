#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "tests/measure/drawn_scenes.hpp"

BOOST_AUTO_TEST_SUITE(chart)

using namespace qddot;

namespace {

using Numbers = std::vector<std::size_t>;

Point point(const char* method, double error, double time, double value = 0.1) {
  return {.method = find_method(method),
          .value = value,
          .outcome = Outcome::reached_end,
          .errors = {.position = error, .velocity = 0, .energy = 0},
          .time = time};
}

Point failed(Outcome outcome) {
  return {.method = find_method("verlet"), .value = 1, .outcome = outcome};
}

Reference reference(double certified = 1e-12) {
  Reference regular;
  regular.end.t = 2;
  regular.certified = {.position = certified, .velocity = certified, .energy = certified};
  return regular;
}

// A motion that is unknown at its end.
Reference chaotic(double floor = 0.01) {
  Reference motion = reference();
  motion.horizon = 1.5;
  motion.lyapunov = 10;
  motion.modal_shares_floor = floor;
  return motion;
}

// A point of a chaotic motion.
Point by_energy(const char* method, double energy, double shares, double time) {
  Point made = point(method, 1, time);
  made.path = {.energy = energy, .modal_shares = shares};
  return made;
}

// The chart at 1e-1, 1e-3 and 1e-5, of a scene whose largest frequency is 10 rad/s.
Chart made(const std::vector<Point>& points, const Reference& of = reference()) {
  return chart_of(points, of, {1e-1, 1e-3, 1e-5}, StabilityMargins(10));
}

Numbers ranked(const Chart& chart, std::size_t row) {
  Numbers numbers;
  for (const Point* one : chart.front[row].ranked) numbers.push_back(chart.number(one));
  return numbers;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_front_has_a_row_for_each_of_nine_accuracies) {
  const auto rows = fastest_at_each_accuracy({}, reference());
  BOOST_TEST_REQUIRE(rows.size() == 9u);
  for (int i = 0; i < 9; ++i) {
    const FrontRow& row = rows[static_cast<std::size_t>(i)];
    BOOST_TEST(row.accuracy == std::pow(10, -1 - i), boost::test_tools::tolerance(1e-15));
    BOOST_TEST((!row.fastest && !row.fastest_hand_written && !row.fastest_sundials));
  }
}

BOOST_AUTO_TEST_CASE(an_error_equal_to_the_accuracy_has_reached_it) {
  const auto reaches = [](double error) {
    return made({point("verlet", error, 1)}, reference(0)).front[1].fastest != nullptr;
  };
  BOOST_TEST(reaches(1e-3));
  BOOST_TEST(!reaches(std::nextafter(1e-3, 1.0)));
}

BOOST_AUTO_TEST_CASE(each_method_is_ranked_by_its_fastest_point) {
  const std::vector<Point> points = {point("verlet", 5e-2, 3), point("verlet", 5e-4, 4),
                                     point("ida", 5e-4, 2), point("rk4", 5e-4, 9)};
  const Chart chart = made(points);
  BOOST_TEST(ranked(chart, 0) == (Numbers{2, 0, 3}), boost::test_tools::per_element());
  BOOST_TEST(ranked(chart, 1) == (Numbers{2, 1, 3}), boost::test_tools::per_element());
  BOOST_TEST(ranked(chart, 2).empty());
  BOOST_TEST(chart.front[1].fastest == &points[2]);
  BOOST_TEST(chart.front[1].runner_up() == &points[1]);
  BOOST_TEST(chart.front[1].fastest_hand_written == &points[1]);
  BOOST_TEST(chart.front[1].fastest_sundials == &points[2]);
  BOOST_TEST(!chart.front[2].runner_up());
}

BOOST_AUTO_TEST_CASE(of_equally_fast_points_the_first_one_wins) {
  std::vector<Point> points = {point("rk4", 5e-2, 1), point("verlet", 5e-2, 1),
                               point("verlet", 5e-3, 1), point("ida", 5e-2, 1)};
  const Numbers first = {0, 1, 3};
  BOOST_TEST(ranked(made(points), 0) == first, boost::test_tools::per_element());
  std::swap(points[0], points[3]);
  BOOST_TEST(ranked(made(points), 0) == first, boost::test_tools::per_element());
  BOOST_TEST(made(points).front[0].fastest->method->name == "ida");
}

BOOST_AUTO_TEST_CASE(an_uncertain_error_is_told_and_reaches_nothing_by_luck) {
  const std::vector<Point> points = {point("verlet", 9e-4, 1), point("ida", 2e-3, 2)};
  const Chart chart = made(points, reference(3e-4));
  BOOST_TEST(chart.views[0].points[0].bounds.at_least == 6e-4, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(chart.views[0].points[0].bounds.at_most == 1.2e-3,
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST((chart.views[0].points[0].is_uncertain && chart.views[0].points[1].is_uncertain));
  BOOST_TEST(!judged(point("verlet", 0.3, 1), chart.reference).is_uncertain);
  BOOST_TEST(known(1e-10, 1e-9).at_least == 0);
  BOOST_TEST(!chart.front[1].fastest);
  BOOST_TEST(why_empty(chart.front[1], chart.reference) == "no method is known to have reached it");
  BOOST_TEST(why_empty(chart.front[2], chart.reference) == "beyond what the reference certifies");
  const Chart missed = made({point("verlet", 1.4e-3, 1)}, reference(3e-4));
  BOOST_TEST(why_empty(missed.front[1], missed.reference) == "no method reached it");
  const auto words = warnings(chart.front[0], chart.reference);
  BOOST_TEST_REQUIRE(words.size() == 1u);  // h = 0.1 s is half of verlet's limit at 10 rad/s
  BOOST_TEST(words[0] == "error known only to within 3.0e-04, as the reference itself is");
}

BOOST_AUTO_TEST_CASE(winners_that_the_clock_cannot_tell_are_named) {
  const auto timed = [](const char* method, double time, double least) {
    Point one = point(method, 1e-4, time);
    one.time_min = least;
    return one;
  };
  const auto said = [](const std::vector<Point>& points) {
    const Chart chart = made(points);
    return warnings(chart.front[0], chart.reference);
  };
  const auto close = said({timed("verlet", 1, 0.95), timed("symmetric6", 1.5, 0.9)});
  BOOST_TEST_REQUIRE(close.size() == 1u);
  BOOST_TEST(close[0].starts_with("symmetric6 may be as fast"));
  BOOST_TEST(said({timed("verlet", 1, 0.95), timed("symmetric6", 1.1, 0.9)}).empty());
  BOOST_TEST(said({timed("verlet", 1, 0.95), timed("symmetric6", 3, 1.1)}).empty());
  // More than a tenth of the points vary.
  BOOST_TEST(disturbance_in_words(made({timed("verlet", 1, 0.7), timed("rk4", 1, 1)}))
                 .starts_with("The times of 1 of 2 points vary"));
  BOOST_TEST(disturbance_in_words(made(std::vector<Point>(10, timed("rk4", 1, 0.9)))) == "");
}

BOOST_AUTO_TEST_CASE(an_accuracy_that_nothing_reached_has_no_row) {
  const Chart chart = made({});
  BOOST_TEST_REQUIRE(chart.front.size() == 3u);
  for (const FrontRow& row : chart.front) {
    BOOST_TEST((!row.fastest && std::isnan(row.stability_margin)));
    BOOST_TEST(why_empty(row, chart.reference) == "no method reached it");
    BOOST_TEST(warnings(row, chart.reference).empty());
  }
  BOOST_TEST(chart.crossings.empty());
  BOOST_TEST(chart.judged_view().staircase.empty());
}

BOOST_AUTO_TEST_CASE(failed_runs_have_no_error_and_reach_nothing) {
  const std::vector<Point> points = {failed(Outcome::diverged), failed(Outcome::newton_failed),
                                     point("verlet", NAN, 1),   point("verlet", 4, 1),
                                     point("verlet", 1e-9, 0),  point("verlet", 1e-9, 1)};
  BOOST_TEST(std::isnan(points[0].errors.position));
  const Chart chart = made(points);
  const auto failure = [&](std::size_t i) {
    return failure_in_words(points[i], chart.judged_view().points[i]);
  };
  BOOST_TEST(failure(0) == "diverged");
  BOOST_TEST(failure(1) == "Newton failed");
  BOOST_TEST(failure(2) == "error not measured");
  BOOST_TEST(failure(3) == "error above 3");
  BOOST_TEST(failure(4) == "not timed");
  BOOST_TEST(failure(5) == "");
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(std::isnan(chart.views[0].points[i].error));
  BOOST_TEST(ranked(chart, 2) == Numbers{5}, boost::test_tools::per_element());
  BOOST_TEST(chart.judged_view().staircase == Numbers{5}, boost::test_tools::per_element());
  for (int outcome = 0; outcome <= static_cast<int>(Outcome::over_budget); ++outcome) {
    Point perfect = point("verlet", 0, 1);
    perfect.outcome = static_cast<Outcome>(outcome);
    const bool counts = made({perfect}).front[2].fastest != nullptr;
    BOOST_TEST(counts == (perfect.outcome == Outcome::reached_end));
  }
}

BOOST_AUTO_TEST_CASE(no_point_beats_one_of_the_staircase) {
  const std::vector<Point> points = {point("verlet", 1e-1, 1), point("verlet", 1e-2, 2),
                                     point("ida", 1e-2, 1.5),  point("ida", 1e-3, 9),
                                     point("rk4", 1e-4, 8),    point("rk4", 1e-13, 20),
                                     point("rk4", 1e-14, 30)};
  const Chart chart = made(points);
  const Numbers all = {0, 2, 4, 5, 6}, own = {0, 1, 4, 5, 6}, others = {2, 3};
  BOOST_TEST(chart.judged_view().staircase == all, boost::test_tools::per_element());
  BOOST_TEST(chart.hand_written == own, boost::test_tools::per_element());
  BOOST_TEST(chart.sundials == others, boost::test_tools::per_element());
}

// verlet (order 2, steps halved) whose error is small by chance at the second step.
BOOST_AUTO_TEST_CASE(a_lucky_run_counts_at_the_largest_error_up_to_where_the_order_shows) {
  const double c = 1e-12;
  const std::vector<Point> points = {
      point("verlet", 0.9, 1, 1.6),       point("verlet", 1e-4, 2, 0.8),
      point("verlet", 0.6, 4, 0.4),       point("verlet", 0.16, 8, 0.2),
      point("verlet", 0.04, 16, 0.1),     point("verlet", 0.01, 32, 0.05),
      point("verlet", 2.5e-3, 64, 0.025), point("verlet", 0.009, 99, 0.0125)};  // rounding
  const Chart chart = made(points);
  const std::vector<double> expected = {0.9, 0.6, 0.6, 0.16, 0.04, 0.01, 0.009, 0.009};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Judged& judged = chart.views[0].points[i];
    BOOST_TEST(judged.counts_at == expected[i] + c, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(judged.bounds.at_most == points[i].errors.position + c);
    BOOST_TEST(judged.is_lucky == (i == 1), i);
  }
  BOOST_TEST(ranked(chart, 0) == Numbers{4}, boost::test_tools::per_element());
  BOOST_TEST(!chart.front[1].fastest);
  // The order of the points does not matter, and they may be mixed with those of other methods.
  std::vector<Point> mixed(points.rbegin(), points.rend());
  mixed.insert(mixed.begin() + 3, point("rk4", 1e-2, 99));
  const Chart other = made(mixed);
  BOOST_TEST(other.views[0].points[7].counts_at == chart.views[0].points[1].counts_at);
  BOOST_TEST(ranked(other, 0) == (Numbers{4, 3}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(a_tolerance_counts_at_the_errors_of_tighter_ones) {
  // Errors fall as tolerances do, from 1e-3 on.
  const std::vector<Point> points = {point("ida", 2e-5, 1, 1e-1), point("ida", 0.3, 2, 1e-2),
                                     point("ida", 0.05, 3, 1e-3), point("ida", 7e-3, 4, 1e-4),
                                     point("ida", 2e-3, 5, 1e-5), point("ida", 9e-3, 6, 1e-6)};
  const Chart chart = made(points);
  BOOST_TEST(chart.views[0].points[0].counts_at == 0.3 + 1e-12);
  BOOST_TEST(chart.views[0].points[2].counts_at == 0.05 + 1e-12);
  BOOST_TEST(chart.front[0].fastest == &points[2]);
  BOOST_TEST(!chart.front[1].fastest);
}

BOOST_AUTO_TEST_CASE(
    a_run_before_a_diverged_one_counts_for_nothing_and_one_over_budget_tells_nothing) {
  std::vector<Point> points = {point("verlet", 0.02, 1, 0.4), failed(Outcome::diverged),
                               point("verlet", 0.01, 3, 0.1)};
  points[1].value = 0.2;
  const Chart chart = made(points);
  BOOST_TEST(std::isinf(chart.views[0].points[0].counts_at));
  BOOST_TEST(chart.views[0].points[0].is_lucky);
  BOOST_TEST(ranked(chart, 0) == Numbers{2}, boost::test_tools::per_element());
  BOOST_TEST(chart.judged_view().staircase == Numbers{2}, boost::test_tools::per_element());
  points[1].outcome = Outcome::over_budget;
  BOOST_TEST(ranked(made(points), 0) == Numbers{0}, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(a_last_run_follows_the_order_after_two_expected_falls) {
  const auto follows = [](double first, double second, double third) {
    return last_follows_order({point("verlet", first, 1, 0.4), point("verlet", second, 2, 0.2),
                               point("verlet", third, 3, 0.1)},
                              reference());
  };
  // A fall by 4 is expected; between 2.8 and 5.7 it is one.
  BOOST_TEST(follows(0.9, 0.2, 0.05));
  BOOST_TEST(follows(0.9, 0.17, 0.058));
  BOOST_TEST(!follows(0.9, 0.15, 0.0375));
  BOOST_TEST(!follows(0.9, 0.2, 0.08));
  BOOST_TEST(!last_follows_order({point("verlet", 1e-3, 1)}, reference()));
}

BOOST_AUTO_TEST_CASE(another_motion_counts_nowhere) {
  const std::vector<Point> points = {by_energy("implicit_euler", 0, 0.11, 1),
                                     by_energy("verlet", 5e-4, 0.02, 2),
                                     by_energy("rk4", 5e-4, 0.1, 3)};
  const Chart chart = made(points, chaotic());
  BOOST_TEST((chart.judge == Quantity::energy));
  BOOST_TEST(!chart.judged_view().points[0].counts);
  BOOST_TEST(ranked(chart, 1) == (Numbers{1, 2}), boost::test_tools::per_element());
  BOOST_TEST(chart.judged_view().staircase == Numbers{1}, boost::test_tools::per_element());
  BOOST_TEST(chart.judged_view().points[1].bounds.at_most == 5e-4 + machine_epsilon);
  BOOST_TEST_REQUIRE(chart.views.size() == 3u);  // nobody measured momenta
  BOOST_TEST((chart.views[2].quantity == Quantity::modes));
  BOOST_TEST(chart.views[2].floor == 0.01);
  BOOST_TEST(floor_in_words(chart.views[2]) == "difference by chance 1e-2");
}

BOOST_AUTO_TEST_CASE(shares_tell_another_motion_by_ten_floors_or_by_four) {
  // One step of local_global over a chain of four nodes keeps the energy to a tenth and has its
  // energy in other modes by 0.85. Ten floors of 0.122 are more than any difference.
  const auto counts = [](double floor, double shares) {
    Reference motion = chaotic(floor);
    motion.modal_shares = Vec::Constant(7, 1.0 / 7);
    return judged(by_energy("local_global", 0.1, shares, 1), motion).counts;
  };
  BOOST_TEST(!counts(0.122, 0.85));
  BOOST_TEST(!counts(0.122, 0.489));
  BOOST_TEST(counts(0.122, 0.487));
  BOOST_TEST(counts(0.09, 0.89));
  BOOST_TEST(!counts(0.09, 0.91));
  BOOST_TEST(!counts(0.25, 0));
}

BOOST_AUTO_TEST_CASE(where_shares_cannot_tell_no_run_is_known_to_be_right) {
  // Four floors are more than the largest difference there is, or one share decides all others.
  const std::vector<Point> points = {by_energy("local_global", 0.1, 0.85, 1),
                                     by_energy("verlet", 1e-6, 0.01, 2)};
  for (const double floor : {0.12, 0.25, 0.7}) {
    Reference motion = chaotic(floor);
    motion.modal_shares = Vec::Constant(floor < 0.25 ? 3 : 7, 0.1);
    const Chart chart = made(points, motion);
    for (const FrontRow& row : chart.front) BOOST_TEST(!row.fastest);
    BOOST_TEST(why_empty(chart.front[1], chart.reference) ==
               "no method is known to have reached it");
    BOOST_TEST(chart.judged_view().staircase.empty());
    const std::string words = caveats(chart.reference).at(0);
    BOOST_TEST(words.ends_with("no run is known to be right."), words);
  }
  // The positions of a regular motion need no shares.
  Reference regular = chaotic(0.5);
  regular.horizon = 3;
  BOOST_TEST(made({point("verlet", 5e-4, 1)}, regular).front[1].ranked.size() == 1u);
}

BOOST_AUTO_TEST_CASE(a_point_has_the_margin_of_its_step) {
  const std::vector<Point> points = {point("verlet", 1e-4, 1, 0.18), point("verlet", 1e-4, 2, 0.22),
                                     point("ida", 1e-4, 3), point("implicit_midpoint", 1e-4, 4)};
  const Chart chart = made(points);
  BOOST_TEST(chart.margins[0] == 0.1, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(chart.margins[1] == -0.1, boost::test_tools::tolerance(1e-12));
  BOOST_TEST((std::isnan(chart.margins[2]) && std::isnan(chart.margins[3])));
  BOOST_TEST(warnings(chart.front[0], chart.reference).at(0) ==
             "10 % below its limit of stability");
  BOOST_TEST(margin_in_words(chart.margins[1]) == "10 % above its limit of stability");
  const Chart without = chart_of(points, reference(), {1e-1}, StabilityMargins(0));
  BOOST_TEST(
      (std::isnan(without.margins[0]) && warnings(without.front[0], without.reference).empty()));
}

BOOST_AUTO_TEST_CASE(a_row_has_the_margin_of_its_step_against_the_scenes_limit) {
  // w = 10 rad/s: verlet's limit is 0.2 s, and h = 0.1 s half of it; rk4's sqrt(8)/10 s.
  const Model scene(drawn("oscillator"));
  const std::vector<Point> points = {point("verlet", 5e-2, 1), point("rk4", 5e-4, 2)};
  const Chart chart = chart_of(points, reference(), {1e-1, 1e-3}, StabilityMargins(scene));
  BOOST_TEST(chart.front[0].stability_margin == 0.5, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(chart.front[1].stability_margin == 1 - 1 / std::sqrt(8),
             boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(the_fastest_method_changes_along_the_accuracies) {
  const Chart chart = made({point("verlet", 5e-2, 1), point("rk4", 5e-6, 5)});
  BOOST_TEST_REQUIRE(chart.crossings.size() == 1u);
  BOOST_TEST(chart.crossings[0].accuracy == 1e-3);
  BOOST_TEST(chart.crossings[0].from->name == "verlet");
  BOOST_TEST(chart.crossings[0].to->name == "rk4");
}

BOOST_AUTO_TEST_CASE(two_methods_take_equally_long_between_two_scenes) {
  // The ratio of their times is x/10.
  BOOST_TEST(equally_long(1, 1000, std::log(0.1), std::log(100)) == 10,
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(equally_long(0, 4, -1, 1) == 2, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(std::isnan(equally_long(1, 10, NAN, 1)));
}

BOOST_AUTO_TEST_CASE(knobs_and_times_are_told_in_few_characters) {
  const Method &fixed = *find_method("verlet"), &adaptive = *find_method("ida");
  BOOST_TEST(knob_in_words(fixed, 5.917159763313609e-4) == "h = 5.917e-4 s");
  BOOST_TEST(knob_in_words(fixed, 0.02) == "h = 0.02 s");
  BOOST_TEST(knob_in_words(fixed, 0.0078125) == "h = 0.007813 s");  // halves go up
  BOOST_TEST(knob_in_words(fixed, 9.99996e-4) == "h = 0.001 s");
  BOOST_TEST(knob_in_words(adaptive, 1e-6) == "rtol = 1e-6");
  BOOST_TEST(time_in_words(3.2e-3) == "3.2 ms");
  BOOST_TEST(time_in_words(9.9995e-4) == "1 ms");
  BOOST_TEST(time_in_words(2.05e-5) == "20.5 µs");
  BOOST_TEST(time_in_words(4e-9) == "4 ns");
  BOOST_TEST(number_in_words(2e-3) == "2e-3");
  BOOST_TEST(number_in_words(3.3e-14) == "3.3e-14");
  BOOST_TEST(number_in_words(0.5) == "0.5");
  BOOST_TEST(number_in_words(1234) == "1.2e3");
}

BOOST_AUTO_TEST_CASE(a_reader_is_told_what_errors_mean) {
  BOOST_TEST(caveats(reference()).empty());
  const auto words = caveats(chaotic(), {.interrupted_by = "SIGINT", .are_times_of_work = true});
  BOOST_TEST_REQUIRE(words.size() == 3u);
  BOOST_TEST(words[0].starts_with("Times are not measured"));
  BOOST_TEST(words[1].starts_with("The study was interrupted by SIGINT: points are missing."));
  BOOST_TEST(
      words[2] ==
      "chaotic: from t = 1.5 s on, two runs that start one rounding apart differ by more than "
      "1e-2 (× 10 in 230 ms).\nPosition errors at T = 2 s mean nothing. Fastest: of the runs "
      "whose energy is in the right modes.");
}

BOOST_AUTO_TEST_SUITE_END()
