#include <algorithm>
#include <cmath>
#include <set>

#include <boost/test/unit_test.hpp>

#include "experiments/sweep/study_file.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(sweep_study)

using namespace qddot;
using sweep::StudyScene;

namespace {

sweep::StudyFile study_of(const std::string& text) {
  const Folder folder;
  return sweep::read_study(folder.write("study.toml", text));
}

std::vector<std::string> labels(const std::string& scenes, const std::string& more = {}) {
  std::vector<std::string> all;
  for (const StudyScene& scene : study_of(more + "scenes = [" + scenes + "]\n").scenes)
    all.push_back(scene.label);
  return all;
}

using Labels = std::vector<std::string>;

void check_refused_study(const std::string& text, const std::vector<std::string>& fragments) {
  const Folder folder;
  const std::string study = folder.write("study.toml", text);
  const Exit end = run("sweep", {"plan", study, "--out", folder / "S"});
  BOOST_TEST(complains(end, 2, "sweep", fragments), text + ": " + end.err);
  BOOST_TEST(contains(end.err, {"study.toml"}), end.err);
  BOOST_TEST(folder.listing() == "study.toml ", folder.listing());
}

}  // namespace

BOOST_AUTO_TEST_CASE(lists_multiply_and_name_what_they_vary) {
  BOOST_TEST((labels("\"cloth\", \"my.toml\"") == Labels{"cloth", "my"}));
  BOOST_TEST((labels("{ generator = \"chain\", nodes = [10, 20], stiffness = [1e4, 1e6] }") ==
              Labels{"chain_nodes=10_stiffness=10000", "chain_nodes=20_stiffness=10000",
                     "chain_nodes=10_stiffness=1e6", "chain_nodes=20_stiffness=1e6"}));
  BOOST_TEST((labels("{ generator = \"chain\", nodes = 5 }") == Labels{"chain"}));
  BOOST_TEST((labels("\"cloth\", { file = \"a/my.toml\", until = 3 }", "until = [1, 2]\n") ==
              Labels{"cloth_until=1", "cloth_until=2", "my"}));
  BOOST_TEST((labels("\"cloth\", \"cloth\", \"tasks.toml\", \"a b.toml\"") ==
              Labels{"cloth", "cloth-2", "tasks-2", "a_b"}));
}

BOOST_AUTO_TEST_CASE(ranges_have_both_ends_and_equal_ratios_or_differences) {
  const auto values = [](const std::string& range) {
    std::vector<double> all;
    for (const StudyScene& scene :
         study_of("scenes = [{ generator = \"chain\", " + range + " }]\n").scenes)
      all.push_back(scene.varied.begin()->second);
    return all;
  };
  const auto linear = values("stiffness = { from = 100, to = 200, count = 3 }");
  BOOST_TEST((linear == std::vector<double>{100, 150, 200}));
  const auto log = values("stiffness = { from = 1, to = 1e6, count = 7, spacing = \"log\" }");
  BOOST_TEST_REQUIRE(log.size() == 7u);
  for (int i = 0; i < 7; ++i)  // pow is right to an ulp or two
    BOOST_TEST(log[static_cast<std::size_t>(i)] == std::pow(10.0, i),
               boost::test_tools::tolerance(1e-14));
  // Whole numbers, each once.
  BOOST_TEST((values("nodes = { from = 3, to = 5, count = 9 }") == std::vector<double>{3, 4, 5}));
}

BOOST_AUTO_TEST_CASE(draws_are_the_same_for_a_seed_within_their_range_and_spread_over_it) {
  const auto drawn = [](int seed) {
    std::vector<double> all;
    for (const StudyScene& scene :
         study_of(
             fmt::format("scenes = [{{ generator = \"chain\", draws = 200, seed = {}, stiffness "
                         "= {{ from = 1, to = 1e6, spacing = \"log\" }} }}]\n",
                         seed))
             .scenes)
      all.push_back(scene.varied.at("stiffness"));
    return all;
  };
  const auto first = drawn(1);
  BOOST_TEST((first == drawn(1)));
  BOOST_TEST((first != drawn(2)));
  double mean = 0;
  for (const double x : first) {
    BOOST_TEST((x >= 1 && x <= 1e6));
    mean += std::log10(x) / 200;
  }
  // Uniform in the logarithm: 3, with a standard error of 6 / sqrt(12 * 200) = 0.12.
  BOOST_TEST(std::abs(mean - 3) < 4 * 0.12);
}

BOOST_AUTO_TEST_CASE(drawn_scenes_with_lists_multiply) {
  const auto scenes = study_of(
                          "scenes = [{ generator = \"chain\", nodes = [3, 4], draws = 5, "
                          "stiffness = { from = 1, to = 2 } }]\n")
                          .scenes;
  BOOST_TEST(scenes.size() == 10u);
  std::set<std::string> distinct;
  for (const StudyScene& scene : scenes) distinct.insert(scene.label);
  BOOST_TEST(distinct.size() == 10u);
}

BOOST_AUTO_TEST_CASE(what_is_wrong_is_said_with_file_line_field_and_value) {
  check_refused_study("scenes = [\"cloth\"]\nmethod = [\"verlet\"]\n",
                      {"study.toml:2: method: it is an unknown key; allowed are"});
  check_refused_study("scenes = []\n", {":1: scenes: [] is not allowed"});
  check_refused_study("until = 1\n", {"scenes: it is missing"});
  check_refused_study("scenes = [\"cloth\"]\nuntil = 0\n", {":2: until: 0 is not allowed"});
  check_refused_study("scenes = [\"cloth\"]\nuntil = [1, 1]\n", {":2: until: [1, 1]", "each once"});
  check_refused_study("scenes = [\"cloth\"]\nmethods = []\n", {":2: methods: []"});
  check_refused_study("scenes = [\"cloth\"]\nmethods = [\"verlt\"]\n", {":2: methods: [", "verlt"});
  check_refused_study("scenes = [\"cloth\"]\nmethods = [\"ida\", \"ida\"]\n",
                      {"ida is named twice"});
  check_refused_study("scenes = [\"cloth\"]\naccuracies = [2]\n", {":2: accuracies: [2", "1e-14"});
  check_refused_study("program = \"modes\"\nscenes = [\"cloth\"]\n", {":1: program: ", "modes"});
  check_refused_study("program = \"advice\"\nscenes = [\"cloth\"]\n", {"scenes: advice draws"});
  check_refused_study("program = \"advice\"\nmethods = [\"ida\"]\n",
                      {"methods: advice takes none"});
  check_refused_study("program = \"energy_drift\"\nscenes = [\"orbit\"]\naccuracies = [1e-3]\n",
                      {"accuracies: only work_precision"});
  check_refused_study("scenes = [{ generator = \"chain\", nodes = [] }]\n",
                      {"scenes[0].nodes: [] is not allowed"});
  check_refused_study("scenes = [{ generator = \"chain\", node = 3 }]\n",
                      {"scenes[0].node: it is no parameter of chain"});
  check_refused_study("scenes = [{ generator = \"chains\" }]\n", {"scenes[0].generator"});
  check_refused_study("scenes = [{ generator = \"chain\", file = \"a\" }]\n", {"exactly one"});
  check_refused_study("scenes = [{ generator = \"chain\", nodes = { from = 1, to = 9 } }]\n",
                      {"scenes[0].nodes.count: it is missing"});
  check_refused_study("scenes = [{ generator = \"chain\", seed = 1 }]\n", {"draws: it is missing"});
  check_refused_study("scenes = [{ generator = \"chain\", draws = 3 }]\n", {"scenes[0].draws"});
  check_refused_study("scenes = [{ generator = \"chain\", nodes = 1e9 }]\n", {"chain", "nodes"});
  check_refused_study("scenes = [\"nowhere.toml\"]\n", {"nowhere"});
  check_refused_study("scenes = [3]\n", {":1: scenes: [3] is not allowed"});
  check_refused_study("scenes = [\"pendulum\"]\n[options]\nout = \"x\"\n", {":3: options.out"});
  check_refused_study("scenes = [\"pendulum\"]\n[options]\npoint-limt = 3\n", {"--point-limt"});
  check_refused_study("scenes = [\"pendulum\"]\n[options]\nrepeats = 0\n", {"--repeats 0"});
  check_refused_study("scenes = [", {"this is not TOML"});
}

BOOST_AUTO_TEST_CASE(too_many_scenes_are_refused_before_any_is_made) {
  const std::string hundred = "{ from = 1, to = 1e6, count = 100 }";
  std::string text = "scenes = [{ generator = \"chain\"";
  for (const char* name : {"length", "mass", "stiffness", "gravity"})
    text += fmt::format(", {} = {}", name, hundred);
  check_refused_study(text + " }]\n", {"multiply to 1e+08 scenes", "100000"});
}

BOOST_AUTO_TEST_SUITE_END()
