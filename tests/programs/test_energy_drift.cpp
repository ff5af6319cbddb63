#include <array>
#include <cmath>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(energy_drift)

using namespace qddot;

namespace {

Exit run_energy_drift(const Folder& folder, std::vector<std::string> words) {
  words.insert(words.end(), {"--out", folder / "out"});
  return run("energy_drift", words);
}

Table table_in(const Folder& folder, const std::string& name) {
  return read_csv(folder / ("out/" + name));
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_run_has_its_path_and_its_verdict) {
  const Folder folder;
  const Exit result = run_energy_drift(
      folder, {"--scene", "orbit", "--step-size", "0.02", "--until", "400", "--methods",
               "verlet,rk4,implicit_euler,explicit_euler,cvode_adams", "--rtol", "1e-4,1e-6"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(folder.listing() == "out ");
  BOOST_TEST(listing(folder / "out") ==
             "drift.csv drift.json summary.csv summary.json tolerance.csv tolerance.json ");

  const Table summary = table_in(folder, "summary.csv");
  BOOST_TEST(
      summary.header.starts_with("method,outcome,drift_rate,drift_rate_low,drift_rate_high,"
                                 "oscillation,verdict,knob,value,"));
  const std::vector<std::string> methods = {"verlet",         "rk4",         "implicit_euler",
                                            "explicit_euler", "cvode_adams", "cvode_adams"};
  BOOST_TEST_REQUIRE(summary.rows.size() == methods.size());
  for (std::size_t i = 0; i < methods.size(); ++i) {
    BOOST_TEST(summary.text(i, "method") == methods[i]);
    const double low = summary.value(i, "drift_rate_low"),
                 high = summary.value(i, "drift_rate_high");
    BOOST_TEST(low <= summary.value(i, "drift_rate"));
    BOOST_TEST(summary.value(i, "drift_rate") <= high);
    const bool says_none = summary.text(i, "verdict").find("no drift") != std::string::npos;
    BOOST_TEST(says_none == (low <= 0 && high >= 0));
  }
  BOOST_TEST(contains(summary.text(0, "verdict"), {"bounded", "no drift"}));
  BOOST_TEST(summary.value(1, "drift_rate_high") < 0);
  BOOST_TEST(contains(summary.text(2, "verdict"), {"dissipates"}));
  BOOST_TEST(summary.value(2, "drift_rate_high") < 0);
  BOOST_TEST(contains(summary.text(3, "verdict"), {"blows up at t = "}));
  BOOST_TEST(summary.text(3, "outcome") == "diverged");
  BOOST_TEST(summary.value(3, "drift_rate_low") > 0);

  const auto origin = nlohmann::json::parse(read_all(folder / "out/drift.json"));
  const Table drift = table_in(folder, "drift.csv");
  BOOST_TEST(drift.header == "method,t,energy,relative_error,knob,value");
  const double scale = origin.at("energy_scale").get<double>();
  double start = 0, last = 0;
  std::string of;
  for (std::size_t i = 0; i < drift.rows.size(); ++i) {
    const std::string run = drift.text(i, "method") + drift.text(i, "value");
    const double t = drift.value(i, "t"), energy = drift.value(i, "energy");
    if (run != of) {
      BOOST_TEST(t == 0);
      start = energy;
    } else {
      BOOST_TEST(t > last);
    }
    of = run;
    last = t;
    const double error = (energy - start) / scale;
    // The error follows from the energy, up to rounding.
    BOOST_TEST(std::abs(drift.value(i, "relative_error") - error) <= 1e-14 * (1 + std::abs(error)));
  }
  // m v^2/2 + k (r - l0)^2/2.
  BOOST_TEST(std::abs(start - (4.5 + 2)) < 1e-13);

  const Table tolerance = table_in(folder, "tolerance.csv");
  BOOST_TEST(tolerance.header ==
             "method,rtol,periods,outcome,drift_rate,drift_rate_low,drift_rate_high,"
             "energy_error_end,steps,time_s");
  BOOST_TEST_REQUIRE(tolerance.rows.size() == 2u);
  BOOST_TEST(tolerance.value(0, "rtol") == 1e-4);
  BOOST_TEST(std::abs(tolerance.value(1, "energy_error_end")) <
             0.1 * std::abs(tolerance.value(0, "energy_error_end")));
  BOOST_TEST(contains(result.out, {"verlet", "cvode_adams 1e-06", "goes as rtol^"}));
}

BOOST_AUTO_TEST_CASE(step_and_horizon_have_defaults) {
  const Folder folder;
  const Exit result =
      run_energy_drift(folder, {"--scene", "oscillator", "--methods", "symplectic_euler"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table summary = table_in(folder, "summary.csv");
  BOOST_TEST(std::abs(summary.value(0, "value") - 0.05) < 1e-12);  // h w = 1/2
  BOOST_TEST(summary.value(0, "steps") == 1e6);
  BOOST_TEST(contains(summary.text(0, "verdict"), {"bounded", "no drift"}));
}

BOOST_AUTO_TEST_CASE(what_drifts_is_the_method_and_not_what_its_solves_leave) {
  const auto rate = [](std::vector<std::string> words) {
    const Folder folder;
    words.insert(words.end(), {"--scene", "orbit", "--until", "5000", "--methods",
                               "trapezoidal,generalized_alpha", "--method-limit", "1000"});
    const Exit result = run_energy_drift(folder, words);
    BOOST_TEST_REQUIRE(result.status == 0, result.err);
    const Table summary = table_in(folder, "summary.csv");
    return std::array{summary.value(0, "drift_rate_low"), summary.value(1, "drift_rate")};
  };
  const auto [least_gain, loss] = rate({});
  const auto [loose_least_gain, loose_loss] = rate({"--solve-tolerance", "0.0001"});
  const auto [tight_least_gain, tight_loss] = rate({"--solve-tolerance", "1e-12"});
  // The trapezoidal rule is conjugate to a symplectic method and bounded.
  BOOST_TEST(tight_least_gain < 0);
  BOOST_TEST(least_gain < 0);
  BOOST_TEST(loose_least_gain > 0);
  // 1e-9 is worth 3e-7 of the loss, 1e-4 a third of it.
  BOOST_TEST(loss == tight_loss, boost::test_tools::tolerance(1e-5));
  BOOST_TEST(loose_loss > 0.8 * tight_loss);
}

BOOST_AUTO_TEST_CASE(compensation_is_for_those_that_take_it) {
  const Folder folder;
  const Exit result = run_energy_drift(
      folder, {"--scene", "orbit", "--until", "100", "--methods", "verlet,rk4", "--compensated"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table summary = table_in(folder, "summary.csv");
  BOOST_TEST(summary.text(0, "compensated") == "yes");
  BOOST_TEST(summary.text(1, "compensated") == "no");
}

BOOST_AUTO_TEST_CASE(a_scene_with_massless_nodes_is_studied_by_those_that_take_them) {
  const Folder folder;
  const std::string path = folder.write(
      "joint.toml",
      "dimension = 2\ngravity = [0, -9.81]\n"
      "nodes = [{position = [0, 0], pinned = true}, {position = [2, 0], pinned = true}, "
      "{position = [1, 0], mass = 0}, {position = [1, -1], mass = 1}]\n"
      "springs = [{nodes = [0, 2], stiffness = 100, rest_length = 0.9}, "
      "{nodes = [1, 2], stiffness = 100, rest_length = 0.9}, {nodes = [2, 3], stiffness = 50}]\n");
  const Exit result = run_energy_drift(
      folder, {"--scene", path, "--methods", "bdf2,implicit_euler", "--until", "20"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table summary = table_in(folder, "summary.csv");
  BOOST_TEST(contains(summary.text(1, "verdict"), {"dissipates"}));
}

BOOST_AUTO_TEST_SUITE_END()
