// The ladder of step sizes near a limit, on made-up runs whose limit is anywhere.
#include <cmath>
#include <functional>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/speed/ladder.hpp"

BOOST_AUTO_TEST_SUITE(ladder)

using namespace qddot;

namespace {

constexpr double failed = INFINITY;
// The least ratio of the largest good step to the largest stable one.
constexpr double near_enough = 0.98;

// The error of a run of so many steps.
using Runs = std::function<double(double steps)>;

// Runs of a method of that order that fail, or leave `beyond`, with fewer steps than `limit`.
Runs limited(double limit, int order, double beyond = failed) {
  return
      [=](double steps) { return steps < limit ? beyond : 1e-2 * std::pow(limit / steps, order); };
}

// Rungs that divide the error by four, from a run that is not good down to 1e-3 of its steps.
std::vector<Rung> coarse_ladder(const Runs& runs, int order, double start) {
  std::vector<Rung> ladder;
  for (double steps = start; steps <= 1e3 * start; steps *= std::pow(4.0, 1.0 / order)) {
    const double whole = std::round(steps);
    if (ladder.empty() || whole > ladder.back().steps) ladder.push_back({whole, runs(whole)});
  }
  return ladder;
}

// The ladder with all missing rungs.
std::vector<Rung> refined(std::vector<Rung> ladder, const Runs& runs) {
  while (const auto steps = lacking_rung(ladder)) {
    const auto finer =
        std::ranges::find_if(ladder, [&](const Rung& rung) { return rung.steps >= *steps; });
    BOOST_REQUIRE(finer != ladder.end());
    BOOST_REQUIRE(finer != ladder.begin());
    BOOST_REQUIRE(finer->steps != *steps);
    BOOST_REQUIRE(*steps == std::round(*steps));
    ladder.insert(finer, {*steps, runs(*steps)});
  }
  return ladder;
}

// The coarsest rung that is good and all finer ones with it.
std::size_t coarsest_good(const std::vector<Rung>& ladder) {
  std::size_t i = ladder.size();
  while (i > 0 && ladder[i - 1].is_good()) --i;
  return i;
}

// Whether the limit is between rungs whose steps are as near as they are to be, or neighbours.
bool is_tight(double coarse, double fine) {
  return coarse >= near_enough * fine || fine - coarse == 1;
}

// The fewest steps of a rung with at most that error; none if there is no such rung.
double fewest(const std::vector<Rung>& ladder, double error) {
  for (const Rung& rung : ladder) {
    if (rung.error <= error) return rung.steps;
  }
  return failed;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_limit_anywhere_is_found_from_both_sides) {
  for (const int order : {1, 2, 4, 8}) {
    for (double limit = 2; limit < 5000; limit *= 1.07) {
      const Runs runs = limited(limit, order);
      const auto ladder =
          refined(coarse_ladder(runs, order, std::max(1.0, std::floor(limit / 3))), runs);
      const std::size_t top = coarsest_good(ladder);
      BOOST_TEST_REQUIRE((top > 0 && top < ladder.size()));
      BOOST_TEST(ladder[top].steps >= limit);
      BOOST_TEST(ladder[top - 1].steps < limit);
      BOOST_TEST(is_tight(ladder[top - 1].steps, ladder[top].steps),
                 "order " << order << ": between " << ladder[top - 1].steps << " and "
                          << ladder[top].steps);
    }
  }
}

// A front needs more steps than the method by at most the ratio of two rungs, 1.04 r^(1/8) at r
// times the steps of the limit. The rung at the limit is within 1/0.98. Whole steps add one.
BOOST_AUTO_TEST_CASE(the_front_is_hardly_worse_than_the_method) {
  for (const int order : {1, 2, 4, 8}) {
    for (const double limit : {60.3, 777.7, 4321.0}) {
      const Runs runs = limited(limit, order);
      const auto coarse = coarse_ladder(runs, order, std::floor(limit / 3));
      const auto ladder = refined(coarse, runs);
      for (double times = 1; times < 8; times *= 1.003) {
        const double steps = times * limit;
        const double allowed = 1.04 * std::pow(times, 0.125) / near_enough;
        BOOST_TEST(fewest(ladder, runs(steps)) <= allowed * steps + 1,
                   "order " << order << " at " << times << " times the steps of the limit");
      }
    }
  }
}

// Halving a ratio of 2 down to 1/0.98 takes 6 runs. There are 8 log(1 + log(8) / (8 log(1.04))) =
// 16.3 ratios 1.04 r^(1/8), r = 1 ... 8, and at most one more for each existing rung. All together
// take a fifth of the steps of a ladder up to 1000 times as many; the limit of a quarter allows for
// roundings.
BOOST_AUTO_TEST_CASE(few_runs_are_enough_and_most_of_them_short) {
  for (const int order : {2, 4, 8}) {
    for (double limit = 20; limit < 5000; limit *= 1.31) {
      const Runs runs = limited(limit, order);
      const auto coarse = coarse_ladder(runs, order, std::floor(limit / 3));
      const auto ladder = refined(coarse, runs);
      const auto more = ladder.size() - coarse.size();
      BOOST_TEST(more <= 30u);
      double spent = 0, before = 0;
      for (const Rung& rung : ladder) spent += rung.steps;
      for (const Rung& rung : coarse) before += rung.steps;
      BOOST_TEST(spent < 1.25 * before, order << ", " << limit << ": " << spent / before);
    }
  }
}

// Instabilities that springs hold within bounds leave an error below 1.
BOOST_AUTO_TEST_CASE(a_limit_where_the_error_jumps_is_one_too) {
  for (const double beyond : {0.9, 0.5}) {
    for (double limit = 30; limit < 3000; limit *= 1.17) {
      const auto worse = limited(limit, 2, beyond);
      const Runs runs = [&](double steps) { return steps < 0.8 * limit ? failed : worse(steps); };
      const auto ladder = refined(coarse_ladder(runs, 2, std::floor(limit / 4)), runs);
      const double top = fewest(ladder, 0.1);
      const auto at = std::ranges::find(ladder, top, &Rung::steps);
      BOOST_TEST(is_tight((at - 1)->steps, at->steps), "limit " << limit);
    }
  }
}

BOOST_AUTO_TEST_CASE(without_a_limit_nothing_is_lacking) {
  // The coarsest run is one of a single step, or a whole motion off and the next one hardly less.
  BOOST_TEST(!lacking_rung({}));
  BOOST_TEST(!lacking_rung({{1, failed}}));
  BOOST_TEST(!lacking_rung({{1, 0.9}, {2, 0.3}, {4, 0.07}}));
  BOOST_TEST(!lacking_rung({{1, failed}, {2, failed}, {4, 1}}));
  BOOST_TEST(!lacking_rung({{1, failed}, {2, 0.1}}));  // no whole number is between
}

// Errors that are small by luck cost some short runs, and far from the limit none.
BOOST_AUTO_TEST_CASE(luck_is_not_taken_for_a_limit_where_steps_are_small) {
  const auto method = limited(100, 2);
  const Runs lucky = [&](double steps) {
    return method(steps) * (steps > 1500 && steps < 1900 ? 1e-3 : 1);
  };
  const auto ladder = refined(coarse_ladder(lucky, 2, 50), lucky);
  const auto in_luck = [](const Rung& rung) { return rung.steps > 1100 && rung.steps < 2500; };
  BOOST_TEST(std::ranges::count_if(ladder, in_luck) == 1);
}

BOOST_AUTO_TEST_SUITE_END()
