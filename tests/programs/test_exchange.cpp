#include <cmath>
#include <map>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(exchange)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

// The chain for 60 s, in which I_1 falls to half, by four methods. One is right, one is too slow at
// steps far above its accuracy, one is unstable there, and one damps.
struct Short {
  Folder folder{};
  Exit result = run("exchange", {"--scene", "fpu", "--until", "60", "--methods",
                                 "verlet,implicit_midpoint,rodas4,implicit_euler", "--h-omega",
                                 "0.1,2.25", "--out", folder / "out"});
  std::string file(const std::string& name) const { return folder / ("out/" + name); }
};

const Short& short_run() {
  static const Short run;
  BOOST_TEST_REQUIRE(run.result.status == 0, run.result.err);
  return run;
}

// The summary's row of a method at a step.
std::size_t row_of(const Table& table, const std::string& method, double h_omega) {
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (table.text(row, "method") == method && table.value(row, "h_omega") == h_omega) return row;
  }
  throw std::runtime_error("no row of " + method);
}

void check_refused(const Words& words, const Words& fragments) {
  qddot::check_refused("exchange", words, fragments);
}

}  // namespace

BOOST_AUTO_TEST_CASE(energies_are_tabulated_by_method_step_time_and_spring) {
  const Table table = read_csv(short_run().file("exchange.csv"));
  BOOST_TEST(table.header == "method,h,h_omega,t,spring,energy");
  std::map<std::pair<std::string, std::string>, double> last;
  double sum = 0;
  int starts = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string spring = table.text(row, "spring");
    const double energy = table.value(row, "energy"), t = table.value(row, "t"),
                 h = table.value(row, "h"), h_omega = table.value(row, "h_omega");
    BOOST_TEST(spring == std::vector<std::string>({"0", "1", "2", "sum"})[row % 4]);
    BOOST_TEST(std::abs(h * 50 - h_omega) < 1e-12);  // w to rounding
    // Whole steps.
    BOOST_TEST(std::abs(t / h - std::round(t / h)) < 1e-8);
    if (t == 0) {
      ++starts;
      // The chain's positions of up to 70 m are right to 2e-14 m, k = 1250 N/m over 0.03 m.
      BOOST_TEST(std::abs(energy - (spring == "0" || spring == "sum" ? 1 : 0)) < 1e-12);
    }
    if (spring == "sum") {
      BOOST_TEST(std::abs(energy - sum) <= 1e-12 * energy);
    }
    sum = spring == "sum" ? 0 : sum + energy;
    last[{table.text(row, "method"), table.text(row, "h_omega")}] = t;
  }
  BOOST_TEST(starts == 4 * 7);  // three methods of two steps, and the reference
  BOOST_TEST(last.size() == 7u);
  // Within a sample, some 0.06 s, of the end, but for the one that blows up.
  for (const auto& [which, t] : last)
    BOOST_TEST((t > 59.9) == (which != std::pair<std::string, std::string>("verlet", "2.25")));
}

BOOST_AUTO_TEST_CASE(each_method_has_its_verdict) {
  const Table table = read_csv(short_run().file("summary.csv"));
  BOOST_TEST(table.header ==
             "method,h,h_omega,outcome,t_reached,steps,force_evaluations,sum_deviation,"
             "energy_error,exchange_error,tempo,misfit,verdict");
  BOOST_TEST(table.rows.size() == 7u);
  const auto verdict = [&](const std::string& method, double h_omega) {
    return table.text(row_of(table, method, h_omega), "verdict");
  };
  const auto value = [&](const std::string& method, double h_omega, const std::string& column) {
    return table.value(row_of(table, method, h_omega), column);
  };
  BOOST_TEST(verdict("reference", 0.1) == "exchanges as it should");
  BOOST_TEST(verdict("verlet", 0.1) == "exchanges as it should");
  BOOST_TEST(verdict("implicit_midpoint", 0.1) == "exchanges as it should");
  // Beyond h w = 2.
  BOOST_TEST(verdict("verlet", 2.25).starts_with("blows up at t = "));
  BOOST_TEST(table.text(row_of(table, "verlet", 2.25), "outcome") == "diverged");
  BOOST_TEST(table.text(row_of(table, "verlet", 2.25), "tempo") == "");
  BOOST_TEST(value("verlet", 2.25, "t_reached") < 1);
  // It sees the vibrations at a lower frequency, (2/h) atan(h w/2).
  BOOST_TEST(contains(verdict("implicit_midpoint", 2.25), {"times too slowly"}));
  BOOST_TEST(value("implicit_midpoint", 2.25, "tempo") < 0.5);
  BOOST_TEST(value("implicit_midpoint", 2.25, "misfit") < 0.1);
  for (const double h_omega : {0.1, 2.25})
    BOOST_TEST(verdict("implicit_euler", h_omega) == "damps: nothing left");
  // The exact motion changes the sum by 0.06 for moments, and H not at all.
  BOOST_TEST(value("reference", 0.1, "sum_deviation") < 0.07);
  BOOST_TEST(value("verlet", 0.1, "sum_deviation") < 0.08);
  BOOST_TEST(value("reference", 0.1, "energy_error") < 1e-9);
  // (h w)^2 / 8 of the vibrations' energy, half of H: Verlet keeps 1/2 v^2 + 1/2 w^2 x^2
  // (1 - (h w)^2/4) of them.
  BOOST_TEST(value("verlet", 0.1, "energy_error") < 1.5e-3);
  BOOST_TEST(value("verlet", 0.1, "energy_error") > 1e-4);
  BOOST_TEST(value("verlet", 0.1, "steps") == 30000);
  BOOST_TEST(value("implicit_euler", 0.1, "sum_deviation") > 0.99);
}

BOOST_AUTO_TEST_CASE(the_sidecar_says_what_w_is_and_how_good_the_reference_is) {
  const auto origin = nlohmann::json::parse(read_all(short_run().file("summary.json")));
  BOOST_TEST(std::abs(double(origin["omega"]) - 50) < 1e-11);
  BOOST_TEST(double(origin["until"]) == 60);
  BOOST_TEST(double(origin["certified"]) < 1e-6);
  BOOST_TEST(double(origin["window"]) == 40 * 2 * M_PI / 50, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(listing(short_run().folder / "out") ==
             "exchange.csv exchange.json summary.csv summary.json ");
}

BOOST_AUTO_TEST_CASE(methods_that_choose_their_steps_are_left_out_with_a_sentence) {
  BOOST_TEST(contains(short_run().result.out, {"rodas4 is left out: it chooses its steps"}));
  check_refused({"--scene", "fpu", "--methods", "rodas4,cvode_bdf", "--out", "OUT"},
                {"rodas4, cvode_bdf", "fixed step"});
}

// Two chains side by side. The second is softer and has no energy, so that it rests.
BOOST_AUTO_TEST_CASE(springs_of_several_parts_are_followed_and_the_fastest_part_sets_w) {
  const Folder folder;
  const std::string scene =
      folder.write("two.toml",
                   "dimension = 1\nuntil = 10\nstiff_above = 50\n"
                   "nodes = [{position = [0], mass = 2}, {position = [1.1], mass = 2},"
                   "{position = [10], mass = 1}, {position = [11], pinned = true}]\n"
                   "springs = [{nodes = [0, 1], stiffness = 400, rest_length = 1},"
                   "{nodes = [2, 3], stiffness = 100, rest_length = 1}]\n");
  const Exit result = run("exchange", {"--scene", scene, "--methods", "verlet", "--h-omega", "0.5",
                                       "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const auto origin = nlohmann::json::parse(read_all(folder / "out/summary.json"));
  BOOST_TEST(std::abs(double(origin["omega"]) - 20) < 1e-11);  // sqrt(400 / 1) against 10
  const Table summary = read_csv(folder / "out/summary.csv");
  BOOST_TEST(summary.text(1, "verdict") == "as it should: no exchange so far");
  const Table table = read_csv(folder / "out/exchange.csv");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double energy = table.value(row, "energy");
    // 1/2 400 0.1^2, which Verlet keeps to (h w)^2/4 = 1/16.
    if (table.text(row, "spring") == "0") BOOST_TEST(std::abs(energy - 2) < 0.13);
    if (table.text(row, "spring") == "1") BOOST_TEST(energy < 1e-20);
  }
}

BOOST_AUTO_TEST_SUITE_END()
