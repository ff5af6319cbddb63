#include <cmath>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(stability_map)

using namespace qddot;

namespace {

Exit run_map(const Folder& folder, std::vector<std::string> words) {
  words.insert(words.end(), {"--out", folder / "out"});
  return run("stability_map", words);
}

Table table(const Folder& folder, const char* name) { return read_csv(folder / "out/" + name); }

// w = sqrt(k/m) = 10 rad/s.
const std::vector<std::string> small = {"--scene", "oscillator", "--amplitudes", "1"};
std::vector<std::string> with(std::vector<std::string> words, std::vector<std::string> more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

BOOST_AUTO_TEST_CASE(limits_are_predicted_and_measured_in_seconds) {
  const Folder folder;
  const Exit result = run_map(
      folder,
      with(small, {"--methods", "explicit_euler,verlet,rk4,implicit_euler", "--columns", "3"}));
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table limits = table(folder, "limits.csv");
  BOOST_TEST(limits.header.starts_with("method,h_limit_predicted,h_limit_measured"));
  BOOST_TEST_REQUIRE(limits.rows.size() == 4u);
  BOOST_TEST(limits.value(0, "h_limit_measured") == 0);
  for (const auto& [row, limit] : {std::pair(1u, 0.2), std::pair(2u, std::sqrt(8) / 10)}) {
    BOOST_TEST(std::abs(limits.value(row, "h_limit_predicted") / limit - 1) < 1e-12);
    BOOST_TEST(std::abs(limits.value(row, "h_limit_measured") / limit - 1) < 1e-8);
    BOOST_TEST(std::abs(limits.value(row, "relative_difference")) < 1e-8);
  }
  BOOST_TEST(limits.text(3, "h_limit_predicted") == "");  // none
  BOOST_TEST(limits.text(3, "h_limit_measured") == "");
  BOOST_TEST(contains(result.out, {"verlet", "2.828427125", "grows at every h", "none"}));
}

BOOST_AUTO_TEST_CASE(a_cell_whose_numbers_overflow_is_an_outcome) {
  const Folder folder;
  const Exit result = run_map(folder, with(small, {"--methods", "verlet,implicit_euler", "--low",
                                                   "1", "--high", "1e300", "--columns", "2"}));
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table map = table(folder, "map.csv");
  BOOST_TEST_REQUIRE(map.rows.size() == 4u);
  BOOST_TEST(map.text(0, "outcome") == "bounded");
  BOOST_TEST(map.text(1, "outcome") != "bounded");
  BOOST_TEST(map.text(1, "predicted_growth_rate") == "");
}

BOOST_AUTO_TEST_CASE(an_amplitude_that_cannot_be_leaves_its_row_out) {
  const Folder folder;
  const std::vector<std::string> varied = {"--scene",   "strut",  "--vary",    "compression",
                                           "--methods", "verlet", "--columns", "2"};
  const Exit some = run_map(folder, with(varied, {"--amplitudes", "0.5,1e9"}));
  BOOST_TEST_REQUIRE(some.status == 0, some.err);
  BOOST_TEST(contains(some.err, {"compression = 1000000000", "its row is left out"}), some.err);
  BOOST_TEST(table(folder, "map.csv").rows.size() == 2u);
  check_refused("stability_map", with(varied, {"--amplitudes", "1e9,2", "--out", "OUT"}),
                {"compression = 1000000000", "not allowed"});
}

BOOST_AUTO_TEST_CASE(the_map_has_a_row_for_each_run_and_theory_beside_it) {
  const Folder folder;
  const Exit result = run_map(folder, with(small, {"--methods", "verlet,implicit_euler,ida",
                                                   "--low", "1", "--high", "4", "--columns", "3"}));
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table map = table(folder, "map.csv");
  BOOST_TEST(map.header.starts_with(
      "method,h,h_omega,amplitude,outcome,growth_rate,predicted_growth_rate"));
  BOOST_TEST_REQUIRE(map.rows.size() == 9u);  // 3 of each, ida's at its tolerances
  for (const std::size_t row : {0u, 1u, 2u}) {
    const double h_omega = map.value(row, "h_omega");
    BOOST_TEST(h_omega == std::pow(2, row), boost::test_tools::tolerance(1e-14));
    BOOST_TEST(map.value(row, "h") == h_omega / 10, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(map.text(row, "outcome") == (h_omega > 2.001 ? "diverged" : "bounded"));
  }
  // rho = 7 + sqrt(48) at h w = 4.
  const double rate = std::log(7 + std::sqrt(48)) / 0.4;
  BOOST_TEST(map.value(2, "predicted_growth_rate") == rate, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(map.value(2, "growth_rate") == rate, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(map.text(3, "outcome") == "leaked");
  BOOST_TEST(map.text(6, "predicted_growth_rate") == "");
  BOOST_TEST(map.text(6, "knob") == "rtol");
  BOOST_TEST(listing(folder / "out") ==
             "adaptive.csv adaptive.json limits.csv limits.json linear.csv linear.json map.csv "
             "map.json modal.csv modal.json ");
  const auto origin = nlohmann::json::parse(read_all(folder / "out/map.json"));
  BOOST_TEST(origin.at("omega_max").get<double>() == 10, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(modes_are_excited_where_the_scene_rests) {
  const Folder folder;
  const Exit result =
      run_map(folder, {"--scene", "pendulum", "--methods", "verlet,implicit_euler", "--step-size",
                       "0.01", "--amplitudes", "0.1", "--columns", "1"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table modal = table(folder, "modal.csv");
  BOOST_TEST_REQUIRE(modal.rows.size() == 6u);
  // Across the spring w = sqrt(g/l), l = 1 + g/k; along it sqrt(k/m).
  const double across = std::sqrt(9.81 / (1 + 9.81 / 1000)), along = std::sqrt(1000);
  for (const auto& [row, w] :
       {std::pair(0u, across), std::pair(1u, across), std::pair(2u, along)}) {
    BOOST_TEST(modal.value(row, "omega") == w, boost::test_tools::tolerance(1e-9));
    BOOST_TEST(modal.text(row, "verdict") == "lives");
    // cos(theta) = 1 - (h w)^2/2; the pendulum's cubic force is (3e-6)^2 of the linear one.
    const double theta = std::acos(1 - 0.5e-4 * w * w);
    BOOST_TEST(std::abs(modal.value(row, "period_error_measured") - (0.01 * w / theta - 1)) < 1e-8);
  }
  BOOST_TEST(modal.text(5, "verdict") == "is damped");  // zeta = atan(x)-like 0.16 at h w = 0.32
}

BOOST_AUTO_TEST_CASE(rows_vary_a_parameter_of_the_generator) {
  const Folder folder;
  const Exit result = run_map(folder, {"--scene", "orbit", "--vary", "radius", "--amplitudes",
                                       "1.1,1.5", "--methods", "verlet", "--columns", "2"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table map = table(folder, "map.csv");
  BOOST_TEST_REQUIRE(map.rows.size() == 4u);
  BOOST_TEST(map.value(0, "amplitude") == 1.1);
  BOOST_TEST(map.value(2, "amplitude") == 1.5);
}

BOOST_AUTO_TEST_CASE(a_scene_without_natural_modes_is_said_to_have_none) {
  const Folder folder;
  const std::string scene = folder.write(
      "loose.toml",
      "dimension = 3\nuntil = 1\ngravity = [0, 0, -9.81]\n"
      "nodes = [{position = [0, 0, 0], pinned = true}, {position = [0.5, 0, 0], mass = 0},"
      " {position = [1, 0, 0.2], mass = 1}]\n"
      "springs = [{nodes = [0, 1], stiffness = 100, rest_length = 0.4},"
      " {nodes = [1, 2], stiffness = 100, rest_length = 0.4}]\n");
  const Exit result = run_map(folder, {"--scene", scene, "--methods", "implicit_euler"});
  BOOST_TEST(complains(result, 3, "stability_map", {"massless node"}), result.err);
}

BOOST_AUTO_TEST_CASE(a_horizon_beyond_all_steps_ends_by_the_limit_of_its_cells) {
  const Folder folder;
  const Exit result = run("stability_map", {"--scene", "oscillator", "--methods", "verlet",
                                            "--until", "1.7976931348623157e308", "--columns", "2",
                                            "--cell-limit", "0.003", "--out", folder / "map"});
  BOOST_TEST(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"over_budget"}), result.out);
}

BOOST_AUTO_TEST_SUITE_END()
