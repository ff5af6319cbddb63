#include <cmath>

#include <boost/test/unit_test.hpp>

#include "experiments/advice/worth.hpp"

BOOST_AUTO_TEST_SUITE(worth)

using namespace qddot;

BOOST_AUTO_TEST_CASE(figures_are_those_of_the_cases_they_are_of) {
  using judged_advice::CaseResult;
  std::vector<CaseResult> cases;
  for (int i = 1; i <= 10; ++i) {
    cases.push_back({.accuracy = 1e-3,
                     .is_claimed = true,
                     .error_estimate = 1e-4 * i,
                     .error = 1e-4,
                     .certified = 1e-9,
                     .best_method = "verlet",
                     .best_seconds = i <= 4 ? 0.03 : 0.001,
                     .run_seconds = i <= 4 ? 0.03 * i : 0.001 * i,
                     .total_seconds = 0.1});
  }
  cases[0].error_estimate = 0.5e-4;  // a bar that does not hold
  cases[9].error = 2e-3;             // a claim that does not
  cases.push_back({.left_out = "no reference", .is_claimed = true, .error = 1});
  const auto figures = judged_advice::worth_of(cases);
  const auto value = [&](const std::string& name) {
    for (const auto& figure : figures) {
      if (figure.name == name) return figure.value;
    }
    return std::nan("");
  };
  // Rounding of quotients and decimals.
  constexpr double rounding = 1e-12;
  BOOST_TEST(std::abs(value("within_accuracy") - 0.9) < rounding);
  BOOST_TEST(std::abs(value("within_bar") - 0.8) < rounding);
  BOOST_TEST(std::abs(value("run_over_best_median") - 5.5) < rounding);
  BOOST_TEST(std::abs(value("run_over_best_90") - 9) < rounding);
  BOOST_TEST(std::abs(value("total_over_best_median") - 0.1 / 0.03) < rounding);
  BOOST_TEST(std::abs(value("bar_over_error_median") - 4.5) < rounding);
}

BOOST_AUTO_TEST_SUITE_END()
