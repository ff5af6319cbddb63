#include <cmath>
#include <set>

#include <boost/test/unit_test.hpp>
#include <fmt/format.h>

#include "experiments/sweep/study_file.hpp"
#include "tests/folder.hpp"

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

BOOST_AUTO_TEST_SUITE_END()
