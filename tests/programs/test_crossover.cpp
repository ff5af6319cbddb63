#include <cmath>
#include <map>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/crossover/pruning.hpp"
#include "qddot/integrators/registry.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(crossover)

using namespace qddot;
using namespace qddot::crossover;

namespace {

using Words = std::vector<std::string>;

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// A finished map, small enough for a test: the motion is as in the default, the cloth is not.
struct Crossed {
  Folder folder{};
  Exit result;
  Table winners, of_kinds, points;

  explicit Crossed(const Words& more) {
    result =
        run("crossover", joined({"--nodes", "5", "--ratios", "1e4,1", "--repeats", "1",
                                 "--point-limit", "5", "--until", "0.1", "--out", folder / "out"},
                                more));
    BOOST_TEST_REQUIRE(result.status == 0, result.err);
    winners = read_csv(folder / "out/crossover.csv");
    of_kinds = read_csv(folder / "out/kinds.csv");
    points = read_csv(folder / "out/points.csv");
  }
};

const Crossed& framed() {
  static const Crossed crossed({"--methods", "verlet,kahan_li8,ida,arkode_dirk3,arkode_imex3"});
  return crossed;
}

// A method's least time for an accuracy at a ratio, from the points; by method.
std::map<std::string, double> times(const Table& points, double ratio, double accuracy) {
  std::map<std::string, double> least;
  for (std::size_t row = 0; row < points.rows.size(); ++row) {
    if (points.value(row, "stiffness_ratio") != ratio) continue;
    if (points.text(row, "outcome") != "reached_end") continue;
    if (points.value(row, "error_position") > accuracy) continue;
    const double time = points.value(row, "time_s");
    const auto [place, is_new] = least.emplace(points.text(row, "method"), time);
    if (!is_new) place->second = std::min(place->second, time);
  }
  return least;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_writes_a_row_for_each_ratio_and_accuracy_in_order) {
  const Table& table = framed().winners;
  BOOST_TEST(table.header == "stiffness_ratio,accuracy,method,time_s,runner_up,margin");
  BOOST_TEST(framed().of_kinds.header == "stiffness_ratio,accuracy,kind,method,time_s");
  BOOST_TEST(framed().points.header.starts_with(
      "stiffness_ratio,scene,method,knob,value,outcome,t_reached,error_position"));
  const std::size_t count = Pruning::accuracies.size();
  BOOST_TEST_REQUIRE(table.rows.size() == 2 * count);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    BOOST_TEST(table.value(row, "stiffness_ratio") == (row < count ? 1 : 1e4));
    BOOST_TEST(table.value(row, "accuracy") == Pruning::accuracies[row % count]);
  }
  BOOST_TEST(listing(framed().folder / "out") ==
             "crossover.csv crossover.json kinds.csv kinds.json points.csv points.json ratio_1 "
             "ratio_10000 ");
}

BOOST_AUTO_TEST_CASE(the_winner_is_the_fastest_point_and_the_margin_that_of_the_next_method) {
  const Table& table = framed().winners;
  int compared = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto least =
        times(framed().points, table.value(row, "stiffness_ratio"), table.value(row, "accuracy"));
    if (least.empty()) {
      BOOST_TEST(table.text(row, "method") == "");
      BOOST_TEST(table.text(row, "time_s") == "");
      continue;
    }
    const std::string& winner = table.text(row, "method");
    BOOST_TEST(table.value(row, "time_s") == least.at(winner));
    double next = std::numeric_limits<double>::infinity();
    for (const auto& [method, time] : least) {
      BOOST_TEST(table.value(row, "time_s") <= time);
      if (method != winner) next = std::min(next, time);
    }
    BOOST_TEST((table.text(row, "runner_up") == "") == (least.size() == 1));
    if (least.size() == 1) continue;
    BOOST_TEST(least.at(table.text(row, "runner_up")) == next);
    BOOST_TEST(table.value(row, "margin") == next / least.at(winner));
    ++compared;
  }
  BOOST_TEST(compared >= 8);  // of 12; what is reached at all depends on the time limit
}

BOOST_AUTO_TEST_CASE(the_fastest_of_each_kind_is_of_that_kind) {
  const Table& table = framed().of_kinds;
  BOOST_TEST(table.rows.size() == 3 * framed().winners.rows.size());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const Method* method = find_method(table.text(row, "method"));
    if (method) BOOST_TEST(kind_name(kind_of(*method)) == table.text(row, "kind"));
  }
}

BOOST_AUTO_TEST_CASE(split_methods_run_only_where_springs_are_stiff) {
  const Table& points = framed().points;
  int split = 0;
  for (std::size_t row = 0; row < points.rows.size(); ++row) {
    if (points.text(row, "method") != "arkode_imex3") continue;
    BOOST_TEST(points.value(row, "stiffness_ratio") == 1e4);
    ++split;
  }
  BOOST_TEST(split > 0);
}

BOOST_AUTO_TEST_CASE(explicit_steps_are_as_many_as_the_root_of_the_ratio_and_implicit_are_not) {
  const auto least_steps = [](const char* method, double ratio, double accuracy) {
    const Table& points = framed().points;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < points.rows.size(); ++row) {
      if (points.text(row, "method") == method && points.value(row, "stiffness_ratio") == ratio &&
          points.text(row, "outcome") == "reached_end" &&
          points.value(row, "error_position") <= accuracy) {
        least = std::min(least, points.value(row, "steps"));
      }
    }
    return least;
  };
  // There are up to sqrt(1e4) = 100 times the steps. They are fewer, since all springs of a node
  // count at ratio 1 and only the frame's at 1e4, and since step sizes differ by factors of two.
  const double grown = least_steps("verlet", 1e4, 0.1) / least_steps("verlet", 1, 0.1);
  BOOST_TEST((grown > 20 && grown < 200), grown);
  BOOST_TEST(least_steps("ida", 1e4, 0.1) / least_steps("ida", 1, 0.1) < 20);
}

BOOST_AUTO_TEST_CASE(a_sidecar_says_how_it_was_made_and_how_certain_it_is) {
  for (const char* name : {"crossover", "kinds", "points"}) {
    const auto json =
        nlohmann::json::parse(read_all(framed().folder / fmt::format("out/{}.json", name)));
    for (const char* key :
         {"command_line", "version", "compiler", "flags", "cpu", "libraries", "date"}) {
      BOOST_TEST(json.contains(key), key);
    }
    BOOST_TEST(json.at("family") == "frame");
    BOOST_TEST(json.at("until") == 0.1);
    BOOST_TEST_REQUIRE(json.at("scenes").size() == 2u);
    const auto& stiffest = json.at("scenes").at(1);
    BOOST_TEST(stiffest.at("stiffness_ratio") == 1e4);
    BOOST_TEST(stiffest.at("scene").at("nodes") == 25);
    BOOST_TEST(
        (stiffest.at("certified_position") > 0 && stiffest.at("certified_position") <= 1e-7));
    BOOST_TEST(stiffest.at("reference_made_by") != "");
  }
}

BOOST_AUTO_TEST_CASE(the_other_families_have_their_maps_too) {
  for (const char* family : {"whole", "chain"}) {
    const Crossed crossed({"--family", family, "--methods", "verlet,ida"});
    BOOST_TEST(crossed.winners.rows.size() == 12u);
    BOOST_TEST(crossed.of_kinds.rows.size() == 24u);  // none is split
    BOOST_TEST(crossed.points.text(0, "scene") == family);
    BOOST_TEST(crossed.winners.text(0, "method") != "");
  }
}

BOOST_AUTO_TEST_CASE(a_second_run_takes_the_references_that_are_there) {
  const Folder folder;
  const Words words = {"--nodes", "5",    "--ratios", "10",           "--methods",     "verlet",
                       "--until", "0.05", "--out",    folder / "out", "--point-limit", "0.05"};
  BOOST_TEST_REQUIRE(run("crossover", words).status == 0);
  const std::string file = folder / "out/ratio_10/reference.json";
  const std::string before = read_all(file);
  BOOST_TEST(before != "");
  BOOST_TEST_REQUIRE(run("crossover", words).status == 0);
  BOOST_TEST(read_all(file) == before);
}

BOOST_AUTO_TEST_CASE(negative_control_a_cell_of_the_other_ratio_has_another_time) {
  const Table& table = framed().winners;
  const std::size_t count = Pruning::accuracies.size();
  const auto least = times(framed().points, 1, Pruning::accuracies[0]);
  BOOST_TEST_REQUIRE(table.text(count, "method") != "");
  const auto found = least.find(table.text(count, "method"));
  BOOST_TEST((found == least.end() || found->second != table.value(count, "time_s")));
}

BOOST_AUTO_TEST_SUITE_END()
