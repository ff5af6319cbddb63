#include <cmath>

#include <boost/test/unit_test.hpp>

#include "experiments/advice/rule_effects.hpp"
#include "experiments/advice/sample_errors.hpp"
#include "experiments/advice/worth.hpp"
#include "qddot/integrators/registry.hpp"

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

BOOST_AUTO_TEST_CASE(a_changed_rule_is_compared_with_the_rules_as_they_are) {
  using judged_advice::RuledAnswer;
  using judged_advice::RuledCase;
  const RuledAnswer usual{.is_claimed = true, .error_estimate = 1e-3, .error = 1e-4, .forces = 100};
  std::vector<RuledCase> cases(
      4, {.is_well_posed = true,
          .answers = std::vector<RuledAnswer>(1 + 2 * all_rules.size(), usual)});
  cases[3].is_well_posed = false;
  // The first rule, halved: a bar that does not hold, a refusal, and half of the forces.
  cases[0].answers[1].error = 2e-3;
  cases[1].answers[1].is_claimed = false;
  cases[2].answers[1].forces = 0;
  const auto effects = judged_advice::effects_of(cases);
  BOOST_TEST_REQUIRE(effects.size() == 1 + 2 * all_rules.size());
  BOOST_TEST(effects[0].within_bar == 100.0);
  BOOST_TEST(effects[0].refused == 0.0);
  BOOST_TEST(effects[1].rule == all_rules[0].first);
  BOOST_TEST(effects[1].factor == 0.5);
  BOOST_TEST(effects[1].within_bar == 50.0);
  BOOST_TEST(std::abs(effects[1].refused - 100.0 / 3) < 1e-12);  // rounding of a quotient
  BOOST_TEST(effects[1].forces == 0.5);
  BOOST_TEST(effects[2].forces == 1.0);
}

BOOST_AUTO_TEST_CASE(samples_are_summed_up_by_method) {
  using judged_advice::SampledCase;
  using judged_advice::SampledRun;
  const std::string one = methods()[1].name, other = methods()[0].name;
  const auto run = [](const std::string& method, double ratio) {
    return SampledRun{
        .method = method, .reached_end = true, .ratio = ratio, .plain_ratio = 10 * ratio};
  };
  const std::vector<SampledCase> cases = {
      {.runs = {run(one, 1), run(one, 3), run(other, 21), SampledRun{.method = other}}},
      {.runs = {run(one, 2), run(one, 30)}}};
  const auto sums = judged_advice::by_method(cases);
  BOOST_TEST_REQUIRE(sums.size() == 2);
  BOOST_TEST(sums[0].method == other);
  BOOST_TEST(sums[0].runs == 1.0);
  BOOST_TEST(sums[0].ended_early == 1.0);
  BOOST_TEST(sums[0].share == 100.0);
  BOOST_TEST(sums[1].method == one);
  BOOST_TEST(sums[1].runs == 4.0);
  BOOST_TEST(sums[1].largest == 30.0);
  BOOST_TEST(sums[1].median == 2.0);
  BOOST_TEST(sums[1].share == 25.0);
  BOOST_TEST(sums[1].plain_largest == 300.0);
  BOOST_TEST(sums[1].plain_share == 50.0);
}

BOOST_AUTO_TEST_SUITE_END()
