#include <cmath>
#include <map>
#include <random>
#include <set>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/scaling/phase_table.hpp"
#include "qddot/algebra/straight_line.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(scaling)

using namespace qddot;
using namespace qddot::scaling;

namespace {

using Words = std::vector<std::string>;

const std::vector<double> decades = {1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5};

std::vector<double> law(double exponent, const std::vector<double>& n) {
  std::vector<double> y;
  for (const double value : n) y.push_back(3e-8 * std::pow(value, exponent));
  return y;
}

// A chain and a cloth of three sizes each.
struct Small {
  Folder folder{};
  Exit result = run("scaling", {"--scenes", "chain,cloth", "--least-nodes", "30", "--most-nodes",
                                "300", "--sizes", "2", "--out", folder / "out"});
  std::string file(const std::string& name) const { return folder / ("out/" + name); }
};

const Small& small() {
  static const Small run;
  BOOST_TEST_REQUIRE(run.result.status == 0, run.result.err);
  return run;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_exact_power_law_is_recovered_to_rounding) {
  for (const double exponent : {0., 1., 4. / 3, 1.5, 2.}) {
    const PowerLaw fit = fit_power_law(decades, law(exponent, decades));
    // Rounding of logarithms up to 20, over a spread of four.
    BOOST_TEST(std::abs(fit.exponent - exponent) < 1e-14);
    BOOST_TEST(fit.high - fit.low < 1e-13);
  }
}

BOOST_AUTO_TEST_CASE(the_interval_covers_the_exponent_as_often_as_it_says) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.1);
  constexpr int trials = 2000;
  int covered = 0;
  for (int i = 0; i < trials; ++i) {
    std::vector<double> y = law(1.5, decades);
    for (double& value : y) value *= std::exp(noise(random));
    const PowerLaw fit = fit_power_law(decades, y);
    covered += fit.low <= 1.5 && 1.5 <= fit.high;
  }
  // 95 % of 2000, within four standard deviations of that count, sqrt(0.95 0.05 / 2000) = 0.005.
  BOOST_TEST(std::abs(static_cast<double>(covered) / trials - 0.95) < 4 * 0.005);
}

BOOST_AUTO_TEST_CASE(too_few_points_have_no_interval_and_one_has_no_exponent) {
  const PowerLaw two = fit_power_law(std::vector{1e2, 1e4}, std::vector{1., 1e3});
  BOOST_TEST(std::abs(two.exponent - 1.5) < 1e-15);
  BOOST_TEST(std::isnan(two.low));
  BOOST_TEST(std::isnan(fit_power_law(std::vector{1e2}, std::vector{1.}).exponent));
  BOOST_TEST(std::isnan(fit_power_law({}, {}).exponent));
}

BOOST_AUTO_TEST_CASE(exponents_are_those_of_the_upper_decades_beside_those_of_theory) {
  std::vector<PhaseCost> costs;
  for (const double n : {1e2, 1e3, 1e4, 1e5, 2e5}) {
    // Below 1e4 nodes something else than the law; it must not count.
    const double seconds = n < 1e4 ? 1 : 1e-9 * n * n;
    costs.push_back({"lattice", n, 13 * n, "m", "factorization", seconds, 80 * n * std::cbrt(n)});
  }
  const auto exponents = exponents_of(costs);
  BOOST_TEST_REQUIRE(exponents.size() == 2u);
  BOOST_TEST(exponents[0].phase == "factorization");
  BOOST_TEST(exponents[0].nodes_from == 1e4);
  BOOST_TEST(std::abs(exponents[0].fit.exponent - 2) < 1e-13);
  BOOST_TEST(std::abs(exponents[0].theory - 2) < 1e-13);
  BOOST_TEST(exponents[1].phase == "fill");
  BOOST_TEST(std::abs(exponents[1].fit.exponent - 4. / 3) < 1e-13);
  BOOST_TEST(std::abs(exponents[1].theory - 4. / 3) < 1e-13);
}

BOOST_AUTO_TEST_CASE(what_is_expected_grows_as_theory_has_it_from_the_last_size) {
  const SizedScenes& cloth = find_sized_scenes("cloth");
  const std::vector<PhaseCost> costs = {{"cloth", 100, 500, "m", "factorization", 9, 9},
                                        {"cloth", 1e4, 5e4, "m", "factorization", 2, 1e9},
                                        {"chain", 1e6, 1e6, "m", "factorization", 5, 5}};
  const double grown = expected_seconds(costs, cloth, "m", "factorization", 4e4);
  BOOST_TEST(std::abs(grown - 2 * 8) < 1e-13);
  const double bytes = expected_bytes(costs, cloth, "m", "factorization", 1e8);
  BOOST_TEST(std::abs(bytes / 1e9 - 2e4) < 1e-10);  // n log n: 10^4 times 2
  BOOST_TEST(expected_seconds(costs, cloth, "m", "solve", 4e4) == 0);
  const std::vector<PhaseCost> iterated = {{"cloth", 1e4, 5e4, "m", "iterations", 2, 0}};
  const double iterations = expected_seconds(iterated, cloth, "m", "iterations", 4e4);
  BOOST_TEST(std::abs(iterations - 2 * 8) < 1e-13);  // four times the nodes, twice the side
}

BOOST_AUTO_TEST_CASE(phases_of_every_scene_and_size_add_up_to_the_step) {
  const Table table = read_csv(small().file("scaling.csv"));
  BOOST_TEST(table.header == "scene,nodes,springs,method,phase,seconds,bytes");
  std::map<std::tuple<std::string, double, std::string>, std::map<std::string, double>> steps;
  std::set<double> chains, cloths;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string scene = table.text(row, "scene"), method = table.text(row, "method");
    const double nodes = table.value(row, "nodes"), springs = table.value(row, "springs");
    (scene == "chain" ? chains : cloths).insert(nodes);
    if (scene == "chain") BOOST_TEST(springs == nodes - 1);
    const auto [place, is_new] = steps[{scene, nodes, method}].insert(
        {table.text(row, "phase"), table.value(row, "seconds")});
    BOOST_TEST(is_new);
    if (place->first != "rest") BOOST_TEST(place->second > 0);
    if (place->first == "factorization") BOOST_TEST(table.value(row, "bytes") > 8 * 3 * nodes);
  }
  BOOST_TEST((chains == std::set<double>{30, 95, 300}));
  BOOST_TEST((cloths == std::set<double>{25, 100, 289}));
  // The phases before any method, an explicit one, and an implicit one with each of two solvers.
  BOOST_TEST(steps.size() == 6u * 4);
  for (const auto& [key, phases] : steps) {
    const std::string& method = std::get<2>(key);
    double sum = 0;
    Words names;
    for (const auto& [phase, seconds] : phases) {
      names.push_back(phase);
      if (phase != "step" && phase != "symbolic") sum += seconds;
    }
    if (method == "verlet") BOOST_TEST((names == Words{"force", "rest", "step"}));
    if (method == "semi_implicit_euler")
      BOOST_TEST((names == Words{"factorization", "force", "rest", "solve", "step", "stiffness",
                                 "symbolic"}));
    if (method == "semi_implicit_euler:conjugate_gradients")
      BOOST_TEST((names == Words{"force", "iterations", "preconditioner", "rest", "step",
                                 "stiffness", "symbolic"}));
    if (method.empty()) {
      BOOST_TEST((names == Words{"reduce", "scene"}));
    } else {
      // Five sums and differences round.
      BOOST_TEST(std::abs(sum - phases.at("step")) < 1e-14 * phases.at("step"));
    }
  }
}

BOOST_AUTO_TEST_CASE(exponents_and_roofline_have_their_tables) {
  const Table exponents = read_csv(small().file("exponents.csv"));
  BOOST_TEST(exponents.header == "scene,method,phase,exponent,low,high,theory,nodes_from,nodes_to");
  for (std::size_t row = 0; row < exponents.rows.size(); ++row) {
    BOOST_TEST(exponents.value(row, "low") <= exponents.value(row, "exponent"));
    BOOST_TEST(exponents.value(row, "exponent") <= exponents.value(row, "high"));
  }
  const Table roofline = read_csv(small().file("roofline.csv"));
  BOOST_TEST(roofline.header ==
             "scene,nodes,springs,seconds,springs_per_second,bytes_per_spring,flops_per_spring,"
             "working_set_bytes,triad_bytes_per_second,peak_flops_per_second");
  BOOST_TEST(roofline.rows.size() == 6u);
  for (std::size_t row = 0; row < roofline.rows.size(); ++row) {
    for (const std::string& name : Words{"seconds", "triad_bytes_per_second"}) {
      BOOST_TEST(roofline.value(row, name) > 0);
    }
    // A vector operation does one multiplication and addition a cycle at the very least; no core
    // does a thousand.
    BOOST_TEST(roofline.value(row, "peak_flops_per_second") > 1e8);
    BOOST_TEST(roofline.value(row, "peak_flops_per_second") < 1e13);
  }
}

BOOST_AUTO_TEST_CASE(what_would_take_too_much_is_left_out_and_said_to_be) {
  const Folder folder;
  const Exit result =
      run("scaling", {"--scenes", "lattice", "--least-nodes", "60", "--most-nodes", "300",
                      "--sizes", "2", "--memory-limit", "1e-9", "--out", folder / "out"});
  BOOST_TEST(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"left out: lattice", "GB"}));
  const auto origin = nlohmann::json::parse(read_all(folder / "out/scaling.json"));
  BOOST_TEST(origin["left_out"].size() > 0u);
  BOOST_TEST(origin["left_out"][0]["scene"] == "lattice");
}

BOOST_AUTO_TEST_CASE(a_first_scene_that_does_not_fit_is_not_drawn) {
  const Folder folder;
  const Exit result =
      run("scaling", {"--scenes", "cloth", "--least-nodes", "1e6", "--most-nodes", "1e6",
                      "--memory-limit", "0.1", "--time-limit", "20", "--out", folder / "out"});
  BOOST_TEST(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"left out: cloth", "GB, more than 0.1 GB"}), result.out);
}

BOOST_AUTO_TEST_SUITE_END()
