#include <cmath>

#include <boost/test/unit_test.hpp>

#include "experiments/crossover/pruning.hpp"
#include "qddot/integrators/registry.hpp"

BOOST_AUTO_TEST_SUITE(pruning)

using namespace qddot;
using namespace qddot::crossover;

namespace {

Point point(const char* method, double error, double time, double value = 0) {
  return {.method = find_method(method),
          .value = value,
          .outcome = Outcome::reached_end,
          .errors = {.position = error},
          .time = time};
}

Reference certain_to(double position) {
  Reference reference;
  reference.certified.position = position;
  return reference;
}

}  // namespace

BOOST_AUTO_TEST_CASE(kinds_are_read_from_the_registry) {
  for (const Method& method : methods()) {
    const Kind kind = kind_of(method);
    BOOST_TEST((kind == Kind::split) == method.asks(Need::split_forces));
    BOOST_TEST((kind == Kind::rods) == method.asks(Need::constraints));
    if (!method.asks(Need::split_forces) && !method.asks(Need::constraints))
      BOOST_TEST((kind == Kind::implicit_steps) == method.is(Trait::implicit));
  }
  BOOST_TEST((kind_of(*find_method("verlet")) == Kind::explicit_steps));
  BOOST_TEST((kind_of(*find_method("ida")) == Kind::implicit_steps));
  BOOST_TEST((kind_of(*find_method("arkode_imex3")) == Kind::split));
  BOOST_TEST((kind_of(*find_method("arkode_mri3")) == Kind::split));
}

BOOST_AUTO_TEST_CASE(steps_above_a_stability_limit_do_not_end_the_race_of_a_method) {
  const Reference reference = certain_to(1e-9);
  Pruning pruning(reference);
  pruning.take({point("ida", 1e-7, 1)});
  for (const double error : {2.0, 1e30, 1e300}) {
    BOOST_TEST(!pruning.is_over(point("linear_midpoint", error, 1e-3)));
  }
  BOOST_TEST(pruning.is_over(point("linear_midpoint", 0.9, 30)));
}

BOOST_AUTO_TEST_CASE(the_fastest_point_that_is_accurate_enough_wins) {
  const std::vector<Point> points = {point("verlet", 5e-2, 1), point("verlet", 5e-3, 2),
                                     point("kahan_li8", 5e-4, 3), point("ida", 5e-4, 1.5),
                                     point("arkode_imex3", 2, 0.1)};
  const auto all = placings(points, certain_to(1e-9));
  BOOST_TEST_REQUIRE(all.size() == 6u);
  BOOST_TEST(all[0].accuracy == 0.1);
  BOOST_TEST(all[0].fastest == &points[0]);
  // Not Verlet again: another method.
  BOOST_TEST(all[0].runner_up == &points[3]);
  BOOST_TEST(all[1].fastest == &points[3]);
  BOOST_TEST(all[1].runner_up == &points[1]);
  BOOST_TEST(all[1].of_kind[0] == &points[1]);
  BOOST_TEST(all[1].of_kind[1] == &points[3]);
  BOOST_TEST(all[1].of_kind[2] == nullptr);
  BOOST_TEST(all[2].of_kind[0] == &points[2]);
  BOOST_TEST(all[3].fastest == nullptr);
  BOOST_TEST(all[3].runner_up == nullptr);
}

BOOST_AUTO_TEST_CASE(a_lucky_run_wins_nothing_and_prunes_nothing) {
  // verlet's error changes its sign at the coarsest step.
  const std::vector<Point> lucky = {point("verlet", 1e-3, 1, 0.4), point("verlet", 0.5, 2, 0.2),
                                    point("verlet", 0.1, 4, 0.1)};
  std::vector<Point> points = lucky;
  points.push_back(point("ida", 1e-3, 3));
  const Reference reference = certain_to(1e-9);
  const auto all = placings(points, reference);
  BOOST_TEST(all[1].fastest == &points[3]);  // 1e-2
  BOOST_TEST(all[1].runner_up == nullptr);
  Pruning pruning(reference);
  pruning.take(lucky);
  pruning.take({points[3]});
  BOOST_TEST(pruning.handicap({points[3]}) == 1);
  BOOST_TEST(std::isinf(pruning.handicap(lucky)));
}

BOOST_AUTO_TEST_CASE(nothing_is_said_below_what_is_certified) {
  const std::vector<Point> points = {point("verlet", 1e-8, 1)};
  const auto all = placings(points, certain_to(2e-5));
  BOOST_TEST(all[3].fastest == &points[0]);  // 1e-4
  BOOST_TEST(all[4].fastest == nullptr);
}

BOOST_AUTO_TEST_CASE(a_method_is_over_where_it_has_arrived_or_comes_too_late) {
  const Reference reference = certain_to(1e-9);
  Pruning pruning(reference);
  // Nobody is known to be faster.
  BOOST_TEST(!pruning.is_over(point("verlet", 1e-3, 100)));
  BOOST_TEST(pruning.is_over(point("verlet", 1e-6, 100)));
  pruning.take({point("ida", 9e-7, 1)});
  BOOST_TEST(pruning.seconds_of_interest() == 20);
  // Order 2 from 1e-4 to 1e-6 takes ten times as long: 20 times the fastest is 2 s here.
  BOOST_TEST(!pruning.is_over(point("verlet", 1e-4, 1.9)));
  BOOST_TEST(!pruning.is_over(point("verlet", 1e-4, 2.1)));  // but 1e-5 it reaches in time
  BOOST_TEST(pruning.is_over(point("verlet", 1e-4, 6.5)));   // sqrt(10) x 6.5 s is late even there
  // Order 1 is too late earlier, an order of 8 later.
  BOOST_TEST(pruning.is_over(point("symplectic_euler", 1e-4, 2.1)));
  BOOST_TEST(!pruning.is_over(point("kahan_li8", 1e-4, 6.5)));
}

BOOST_AUTO_TEST_CASE(the_accuracies_that_are_not_certified_do_not_keep_a_method_going) {
  const Reference reference = certain_to(1e-5);
  Pruning pruning(reference);
  BOOST_TEST(pruning.is_over(point("verlet", 1e-5, 1)));
  BOOST_TEST(!pruning.is_over(point("verlet", 2e-5, 1)));
}

BOOST_AUTO_TEST_CASE(the_handicap_is_that_where_a_method_is_best) {
  const Reference reference = certain_to(1e-9);
  Pruning pruning(reference);
  pruning.take({point("ida", 1e-3, 1)});
  pruning.take({point("ida", 9e-7, 4)});
  BOOST_TEST(pruning.handicap({point("verlet", 1e-2, 5), point("verlet", 1e-5, 8)}) == 2);
  BOOST_TEST(std::isinf(pruning.handicap({point("verlet", 0.5, 1)})));
}

BOOST_AUTO_TEST_SUITE_END()
