// Runs that are asked for by their accuracy: advise, and simulate --accuracy.
#include <cmath>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/advice/worth.hpp"
#include "qddot/integrators/registry.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(advise)

using namespace qddot;

BOOST_AUTO_TEST_CASE(it_says_what_to_take_and_the_command_line_runs) {
  const Folder folder;
  const Exit result = run("advise", {"--scene", "cloth", "--until", "0.05", "--accuracy",
                                     "1e-2,1e-4,1e-8", "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"w_max", "own frequency", "stable up to", "take"}));
  BOOST_TEST(read_all(folder / "out/advice.csv")
                 .starts_with("accuracy,method,knob,value,predicted_error,predicted_time_s,"
                              "runner_up,margin\n"));
  const Table table = read_csv(folder / "out/advice.csv");
  BOOST_TEST_REQUIRE(table.rows.size() == 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    const std::string& name = table.text(row, "method");
    BOOST_TEST_REQUIRE(find_method(name), name);
    BOOST_TEST(table.value(row, "predicted_error") <= table.value(row, "accuracy"));
    BOOST_TEST(table.value(row, "margin") >= 1);
    BOOST_TEST(find_method(table.text(row, "runner_up")));
    const Exit followed =
        run("simulate", {"--scene", "cloth", "--until", "0.05", "--method", name,
                         table.text(row, "knob") == "rtol" ? "--rtol" : "--step-size",
                         table.text(row, "value")});
    BOOST_TEST(followed.status == 0, followed.err);
    BOOST_TEST(contains(result.out, {"--method " + name}));
  }
}

BOOST_AUTO_TEST_CASE(the_command_line_has_the_reductions_that_were_left_out) {
  const Exit result = run("advise", {"--scene", "pendulum", "--until", "1", "--accuracy", "1e-3",
                                     "--no-reduce", "dimension,mirror"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(
      contains(result.out, {"simulate --scene pendulum --no-reduce dimension,mirror --until 1 "}),
      result.out);
}

BOOST_AUTO_TEST_CASE(an_answer_has_its_error_bar_in_words_and_beside_its_file) {
  const Folder folder;
  const Exit result =
      run("simulate", {"--scene", "pendulum", "--until", "2", "--accuracy", "1e-6", "--final",
                       folder / "end.csv", "--energy", folder / "energy.csv", "--every", "0.5"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"error at most", "for its check"}));
  const auto origin = nlohmann::json::parse(read_all(folder / "end.json"));
  const std::string name = origin.at("method");
  const Method& method = *find_method(name);
  BOOST_TEST(origin.at("is_reached") == true);
  BOOST_TEST(origin.at("error_estimate").get<double>() <= 1e-6);
  // Which check is the cheaper one is decided by measured times.
  const std::string kind = origin.at("error_estimate_kind");
  BOOST_TEST((kind == "compared" || kind == "refined"), kind);
  BOOST_TEST(origin.at("accuracy_of") == "positions");
  BOOST_TEST(origin.at("advised_by") == "forecast");
  BOOST_TEST(origin.at("horizon").is_null());
  double phases = 0;
  for (const auto& [phase, seconds] : origin.at("seconds_by_phase").items())
    phases += seconds.get<double>();
  BOOST_TEST(std::abs(phases / origin.at("seconds").get<double>() - 1) < 1e-9);
  BOOST_TEST(read_csv(folder / "energy.csv").rows.size() == 5u);
  // The same end as by the method that it names.
  const Exit named = run("simulate", {"--scene", "pendulum", "--until", "2", "--method", name,
                                      method.knob == Knob::rtol ? "--rtol" : "--step-size",
                                      fmt::format("{:.17g}", origin.at("value").get<double>()),
                                      "--final", folder / "2.csv"});
  BOOST_TEST_REQUIRE(named.status == 0, named.err);
  if (method.knob == Knob::step_size)
    BOOST_TEST(read_all(folder / "end.csv") == read_all(folder / "2.csv"));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_had_is_said_and_what_was_reached_is_there) {
  const Folder folder;
  const std::string scene = folder.write(
      "chain.toml", "until = 12\n[generator]\nkind = \"chain\"\nnodes = 4\nstiffness = 1000\n");
  const Exit late =
      run("simulate", {"--scene", scene, "--accuracy", "1e-4", "--final", folder / "end.csv"});
  BOOST_TEST(complains(late, 3, "simulate", {"was not reached", "chaotic", "energy"}));
  BOOST_TEST(read_csv(folder / "end.csv").rows.size() == 4u);
  const auto origin = nlohmann::json::parse(read_all(folder / "end.json"));
  BOOST_TEST(origin.at("is_reached") == false);
  BOOST_TEST(origin.at("horizon").get<double>() < 12);
  const Exit advised = run("advise", {"--scene", scene, "--accuracy", "1e-4"});
  BOOST_TEST(advised.status == 3);
  BOOST_TEST(contains(advised.out, {"none: the motion is chaotic", "energy"}), advised.out);
}

BOOST_AUTO_TEST_CASE(the_study_judges_what_was_claimed) {
  const Folder folder;
  const Exit result = run("advice", {"--cases", "3", "--first", "11000000", "--repeats", "1",
                                     "--reference-seconds", "1", "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(read_csv(folder / "out/cases.csv").rows.size() == 3u);
  const Table worth = read_csv(folder / "out/worth.csv");
  BOOST_TEST(worth.rows.size() >= 9u);
}

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
