#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "experiments/sweep/results.hpp"
#include "qddot/integrators/registry.hpp"
#include "tests/folder.hpp"

BOOST_AUTO_TEST_SUITE(sweep_results)

using namespace qddot;
using qddot::sweep::SceneResult;

namespace {

measure::Point point(const char* method, double time, double error = 1e-3) {
  return {.method = find_method(method),
          .value = 1e-3,
          .outcome = Outcome::reached_end,
          .errors = {.position = error},
          .time = time};
}

// A scene whose stiffness is k, and the points on it.
SceneResult scene(double k, std::vector<measure::Point> points) {
  SceneResult result;
  result.label = fmt::format("k={}", k);
  result.varied = {{"stiffness", k}};
  result.until = 1;
  result.reference.certified = {1e-12, 1e-12, 1e-12};
  result.points = std::move(points);
  return result;
}

WrittenTable crossovers(const std::vector<SceneResult>& results) {
  const Folder folder;
  sweep::write_crossovers(folder / "crossovers.csv", results, {1e-2}, nlohmann::json::object());
  return {folder / "crossovers.csv",
          {"along", "accuracy", "low", "high", "crossing", "scene_low", "scene_high", "method_low",
           "method_high", "margin"}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_fastest_of_each_scene_has_the_next_method_and_its_margin) {
  const Folder folder;
  sweep::write_fastest(folder / "fastest.csv",
                       {scene(1, {point("verlet", 3), point("verlet", 2), point("ida", 5)}),
                        scene(2, {point("ida", 1, 5e-2)})},
                       {1e-1, 1e-2}, nlohmann::json::object());
  const WrittenTable table(folder / "fastest.csv", {"method", "time_s", "runner_up", "margin"});
  BOOST_TEST_REQUIRE(table.size() == 4u);
  for (const std::size_t row : {0u, 1u}) {
    BOOST_TEST(table.text(row, "method") == "verlet");
    BOOST_TEST(table.number(row, "time_s") == 2);
    BOOST_TEST(table.text(row, "runner_up") == "ida");
    BOOST_TEST(table.number(row, "margin") == 2.5);
  }
  BOOST_TEST(table.text(2, "method") == "ida");
  BOOST_TEST(table.text(2, "margin") == "");
  BOOST_TEST(table.text(3, "method") == "");
}

BOOST_AUTO_TEST_CASE(two_methods_cross_where_they_take_equally_long) {
  // verlet takes k / 1 s, ida 10 s: equal at k = 10, a hundred and ten times apart at the ends.
  // Given out of order, and with a method that is never the fastest.
  const WrittenTable table =
      crossovers({scene(100, {point("verlet", 100), point("ida", 10)}),
                  scene(0.1, {point("verlet", 0.1), point("ida", 10), point("rk4", 5)})});
  BOOST_TEST_REQUIRE(table.size() == 1u);
  BOOST_TEST(table.text(0, "along") == "stiffness");
  BOOST_TEST(table.number(0, "low") == 0.1);
  BOOST_TEST(table.number(0, "high") == 100);
  BOOST_TEST(table.text(0, "method_low") == "verlet");
  BOOST_TEST(table.text(0, "method_high") == "ida");
  // Rounding of a few logarithms and powers.
  BOOST_TEST(table.number(0, "crossing") == 10, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(table.number(0, "margin") == 10, boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(the_clearest_come_first_and_what_is_not_known_is_empty) {
  const WrittenTable table = crossovers(
      {scene(1, {point("verlet", 1), point("ida", 1.1)}),
       scene(2, {point("verlet", 3), point("ida", 1), point("rk4", 9)}),
       scene(3, {point("ida", 5), point("rk4", 2)}), scene(4, {point("symmetric4", 1)})});
  BOOST_TEST_REQUIRE(table.size() == 3u);
  BOOST_TEST(table.number(0, "low") == 2);  // rk4 is 9 times, ida 2.5 times slower
  BOOST_TEST(table.number(0, "margin") == 2.5, boost::test_tools::tolerance(1e-13));
  BOOST_TEST(table.number(1, "low") == 1);
  BOOST_TEST(table.number(1, "margin") == 1.1, boost::test_tools::tolerance(1e-13));
  // Neither method is known at the other's end.
  BOOST_TEST(table.number(2, "low") == 3);
  BOOST_TEST(table.text(2, "crossing") == "");
  BOOST_TEST(table.text(2, "margin") == "");
}

BOOST_AUTO_TEST_CASE(scenes_that_differ_in_more_than_one_thing_are_no_neighbours) {
  auto low = scene(1, {point("verlet", 1)}), high = scene(2, {point("ida", 1)});
  low.varied["nodes"] = 3;
  high.varied["nodes"] = 4;
  BOOST_TEST(crossovers({low, high}).size() == 0u);
  high.varied["nodes"] = 3;
  BOOST_TEST(crossovers({low, high}).size() == 1u);
  high.entry = 1;  // of the study's list
  BOOST_TEST(crossovers({low, high}).size() == 0u);
}

BOOST_AUTO_TEST_CASE(only_points_that_are_known_to_be_accurate_enough_count) {
  const auto poor = scene(1, {point("verlet", 1, 2e-2), point("ida", 5)}),
             good = scene(2, {point("ida", 5)});
  BOOST_TEST(crossovers({poor, good}).size() == 0u);
}

BOOST_AUTO_TEST_SUITE_END()
