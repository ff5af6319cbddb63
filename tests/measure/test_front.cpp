#include <cmath>
#include <limits>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/front.hpp"
#include "qddot/measure/speed/judgement.hpp"
#include "qddot/scene/generators.hpp"

BOOST_AUTO_TEST_SUITE(front)

using namespace qddot;

namespace {

Point point(const char* method, double error, double time) {
  return {.method = find_method(method),
          .value = 0.1,
          .outcome = Outcome::reached_end,
          .errors = {.position = error},
          .time = time};
}

std::vector<FrontRow> front_of(const std::vector<Point>& points, double certified = 1e-15) {
  Reference reference;
  reference.certified.position = certified;
  return fastest_at_each_accuracy(points, reference);
}

}  // namespace

BOOST_AUTO_TEST_CASE(there_is_a_row_for_each_of_nine_accuracies) {
  const auto rows = front_of({});
  BOOST_TEST_REQUIRE(rows.size() == 9u);
  for (int i = 0; i < 9; ++i) {
    const FrontRow& row = rows[static_cast<std::size_t>(i)];
    BOOST_TEST(row.accuracy == std::pow(10, -1 - i), boost::test_tools::tolerance(1e-15));
    BOOST_TEST(!row.fastest);
    BOOST_TEST(!row.fastest_hand_written);
    BOOST_TEST(!row.fastest_sundials);
  }
}

BOOST_AUTO_TEST_CASE(the_fastest_point_that_is_accurate_enough_is_taken) {
  const std::vector<Point> points = {point("verlet", 5e-2, 1), point("verlet", 5e-4, 4),
                                     point("implicit_euler", 5e-4, 3), point("verlet", 5e-6, 2),
                                     point("verlet", 5e-8, 9)};
  const auto rows = front_of(points);
  const std::array<const Point*, 9> expected = {&points[0], &points[3], &points[3],
                                                &points[3], &points[3], &points[4],
                                                &points[4], nullptr,    nullptr};
  for (std::size_t i = 0; i < 9; ++i) BOOST_TEST(rows[i].fastest == expected[i], "row " << i);
}

BOOST_AUTO_TEST_CASE(the_margin_of_stability_is_that_of_the_step_against_the_limit) {
  // w = 10 rad/s: verlet's limit is 0.2 s, and h = 0.1 s half of it; rk4's sqrt(8)/10 s.
  const ReducedScene scene(generate(*find_generator("oscillator"), {}, "oscillator"));
  const std::vector<Point> points = {point("verlet", 5e-2, 1), point("rk4", 5e-4, 2),
                                     point("implicit_midpoint", 5e-6, 3), point("ida", 5e-8, 4)};
  auto rows = front_of(points);
  add_stability_margins(rows, StabilityMargins(scene));
  BOOST_TEST(rows[0].stability_margin == 0.5, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(rows[2].stability_margin == 1 - 1 / std::sqrt(8), boost::test_tools::tolerance(1e-9));
  BOOST_TEST(std::isnan(rows[4].stability_margin));  // implicit,
  BOOST_TEST(std::isnan(rows[6].stability_margin));  // of adaptive steps,
  BOOST_TEST(std::isnan(rows[8].stability_margin));  // and none at all
}

BOOST_AUTO_TEST_CASE(beyond_the_horizon_the_energy_on_the_way_counts) {
  Reference reference;
  reference.certified.position = 0.1;
  reference.end.t = 2;
  std::vector<Point> points = {point("verlet", 0.3, 1), point("rk4", 1e-9, 2)};
  points[0].path.energy = 5e-4;
  points[1].path.energy = 5e-2;
  const auto fastest = [&](double horizon) {
    reference.horizon = horizon;
    return fastest_at_each_accuracy(points, reference)[2].fastest;
  };
  BOOST_TEST(fastest(1.3) == &points[0]);
  BOOST_TEST(fastest(2.1) == nullptr);  // not certain to 1e-3
  reference.certified.position = 1e-4;
  BOOST_TEST(fastest(2.1) == &points[1]);
}

BOOST_AUTO_TEST_CASE(beyond_the_horizon_energy_in_other_modes_does_not_count) {
  // A run that does not move conserves its energy.
  Reference reference;
  reference.end.t = 2;
  reference.horizon = 1.3;
  reference.modal_shares_floor = 0.01;
  std::vector<Point> points = {point("implicit_euler", 0.9, 1), point("verlet", 0.3, 2)};
  points[0].path = {.energy = 0, .modal_shares = 0.11};
  points[1].path = {.energy = 5e-4, .modal_shares = 0.02};
  BOOST_TEST(fastest_at_each_accuracy(points, reference)[2].fastest == &points[1]);
  points[0].path.modal_shares = 0.09;
  BOOST_TEST(fastest_at_each_accuracy(points, reference)[2].fastest == &points[0]);
}

BOOST_AUTO_TEST_CASE(each_family_has_its_own_fastest) {
  const std::vector<Point> points = {point("verlet", 1e-3, 2), point("ida", 1e-3, 1),
                                     point("arkode_dirk4", 1e-5, 7), point("verlet", 1e-5, 5)};
  const auto rows = front_of(points);
  BOOST_TEST(rows[1].fastest == &points[1]);
  BOOST_TEST(rows[1].fastest_sundials == &points[1]);
  BOOST_TEST(rows[1].fastest_hand_written == &points[0]);
  BOOST_TEST(rows[3].fastest == &points[3]);
  BOOST_TEST(rows[3].fastest_sundials == &points[2]);
}

BOOST_AUTO_TEST_CASE(an_error_equal_to_the_accuracy_has_reached_it) {
  const double accuracy = front_of({})[4].accuracy;
  const std::vector<Point> points = {point("verlet", accuracy, 1)};
  BOOST_TEST(front_of(points, 0)[4].fastest == points.data());
  BOOST_TEST(!front_of(points, 0)[5].fastest);
  const std::vector<Point> beyond = {point("verlet", std::nextafter(accuracy, 1.0), 1)};
  BOOST_TEST(!front_of(beyond, 0)[4].fastest);
}

BOOST_AUTO_TEST_CASE(a_row_is_for_those_that_reached_it_whatever_the_reference_is_off_by) {
  // The faster one's error is 1.2e-9 if the reference is off to its side by all it may be.
  const std::vector<Point> points = {point("verlet", 7e-10, 1), point("ida", 3e-10, 2)};
  const FrontRow row = front_of(points, 5e-10)[8];
  BOOST_TEST(row.fastest == &points[1]);
  BOOST_TEST(row.fastest_hand_written == nullptr);
  const FrontRow open = front_of({points[0]}, 5e-10)[8];
  BOOST_TEST((!open.fastest && open.may_be_reached));
  const std::vector<Point> off = {point("verlet", 1.6e-9, 1)};
  BOOST_TEST(!front_of(off, 5e-10)[8].may_be_reached);
}

BOOST_AUTO_TEST_CASE(an_error_is_known_to_within_what_the_reference_is_off_by) {
  BOOST_TEST(known(3e-9, 1e-9).at_least == 2e-9, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(known(3e-9, 1e-9).at_most == 4e-9, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(known(1e-10, 1e-9).at_least == 0);
  Reference reference;
  reference.certified.position = 1e-9;
  BOOST_TEST(judged(point("verlet", 3e-9, 1), reference).is_uncertain);
  BOOST_TEST(!judged(point("verlet", 1e-6, 1), reference).is_uncertain);
}

BOOST_AUTO_TEST_CASE(no_row_claims_more_than_the_reference_certifies) {
  const std::vector<Point> points = {point("verlet", 0, 1)};
  const auto rows = front_of(points, 2e-5);
  for (std::size_t i = 0; i < 9; ++i) {
    BOOST_TEST(rows[i].fastest == (i < 4 ? points.data() : nullptr), "row " << i);
    BOOST_TEST(rows[i].fastest_hand_written == rows[i].fastest);
  }
}

BOOST_AUTO_TEST_CASE(points_that_failed_do_not_count) {
  std::vector<Point> points;
  for (int outcome = 0; outcome <= static_cast<int>(Outcome::over_budget); ++outcome) {
    if (outcome == static_cast<int>(Outcome::reached_end)) continue;
    points.push_back(point("verlet", 0, 0));
    points.back().outcome = static_cast<Outcome>(outcome);
  }
  points.push_back(point("ida", std::numeric_limits<double>::quiet_NaN(), 0));
  for (const FrontRow& row : front_of(points)) BOOST_TEST(!row.fastest);
}

BOOST_AUTO_TEST_CASE(negative_control_a_faster_point_displaces_the_row) {
  std::vector<Point> points = {point("verlet", 9e-4, 2), point("ida", 9e-4, 3)};
  BOOST_TEST(front_of(points)[2].fastest->method->name == "verlet");
  points[1].time = 1;
  BOOST_TEST(front_of(points)[2].fastest->method->name == "ida");
}

BOOST_AUTO_TEST_SUITE_END()
