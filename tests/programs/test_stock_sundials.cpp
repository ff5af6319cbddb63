#include <cmath>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "qddot/integrators/registry.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(stock_sundials)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

const std::string columns =
    "scene,method,rtol,outcome,stock_outcome,structured_s,stock_s,ratio,structured_error,"
    "stock_error,steps,stock_steps,newton_iterations,stiffness_evaluations,factorizations,"
    "stock_factorizations,indefinite_factorizations,structured_force,structured_stiffness,"
    "structured_factorization,structured_solve,structured_rest,stock_force,stock_stiffness,"
    "stock_factorization,stock_solve,stock_rest";

const std::array<const char*, 5> shares = {"force", "stiffness", "factorization", "solve", "rest"};

const std::string chain =
    "name = \"few\"\nuntil = 0.05\n[generator]\nkind = \"chain\"\nnodes = 6\nstiffness = 1e3\n";

// The methods that there are in both ways.
Words pairs() {
  Words names;
  for (const Method& method : methods()) {
    if (!method.stock_of.empty()) names.push_back(method.stock_of);
  }
  return names;
}

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// A finished comparison.
struct Compared {
  Folder folder{};
  Exit result;
  Table table;

  // `text`: a scene file's, or a generator's name.
  Compared(const std::string& text, const Words& more) {
    const bool is_file = text.find('\n') != std::string::npos;
    const std::string scene = is_file ? folder.write("scene.toml", text) : text;
    result = run("stock_sundials",
                 joined({"--scene", scene, "--repeats", "1", "--out", folder / "out"}, more));
    BOOST_TEST_REQUIRE(result.status == 0, result.err);
    table = read_csv(folder / "out/structure.csv");
  }
};

const Compared& all_pairs() {
  static const Compared compared(chain, {"--rtol", "1e-3,1e-6"});
  return compared;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_writes_a_row_for_each_method_and_tolerance_in_order) {
  const Table& table = all_pairs().table;
  BOOST_TEST(table.header == columns);
  BOOST_TEST_REQUIRE(table.rows.size() == 2 * pairs().size());
  BOOST_TEST(pairs().size() == 6u);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    BOOST_TEST(table.text(row, "scene") == "few");
    BOOST_TEST(table.text(row, "method") == pairs()[row / 2]);
    BOOST_TEST(table.value(row, "rtol") == (row % 2 == 0 ? 1e-3 : 1e-6));
    BOOST_TEST(table.text(row, "outcome") == "reached_end");
    BOOST_TEST(table.text(row, "stock_outcome") == "reached_end");
  }
  BOOST_TEST(all_pairs().result.err == "");
}

BOOST_AUTO_TEST_CASE(both_ways_take_the_same_steps_to_the_same_error) {
  const Table& table = all_pairs().table;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    BOOST_TEST_CONTEXT(table.text(row, "method") << " " << table.text(row, "rtol")) {
      const double error = table.value(row, "structured_error");
      BOOST_TEST((error > 0 && error < 0.1));
      // Rounding alone sets them apart, by up to 7e-9 of the error, and by 2e-6 where ARKODE takes
      // rates from differences of solutions.
      BOOST_TEST(std::abs(table.value(row, "stock_error") / error - 1) <
                 (table.text(row, "method").starts_with("arkode") ? 1e-5 : 1e-6));
      BOOST_TEST(table.value(row, "steps") == table.value(row, "stock_steps"));
      BOOST_TEST(table.value(row, "factorizations") == table.value(row, "stock_factorizations"));
      BOOST_TEST(table.value(row, "steps") > 0);
      BOOST_TEST(table.value(row, "newton_iterations") > 0);
      BOOST_TEST(table.value(row, "stiffness_evaluations") > 0);
      BOOST_TEST(table.value(row, "indefinite_factorizations") <=
                 table.value(row, "factorizations"));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_shares_of_a_runs_time_are_all_of_it) {
  const Table& table = all_pairs().table;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    for (const char* way : {"structured_", "stock_"}) {
      double sum = 0;
      for (const char* share : shares) {
        const double value = table.value(row, std::string(way) + share);
        BOOST_TEST((value > 0 && value < 1));
        sum += value;
      }
      BOOST_TEST(std::abs(sum - 1) < 5 * 2.2e-16);  // five numbers below 1, each rounded
    }
  }
}

BOOST_AUTO_TEST_CASE(the_ratio_of_one_pair_of_runs_is_that_of_their_times) {
  const Table& table = all_pairs().table;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double seconds = table.value(row, "structured_s");
    BOOST_TEST(seconds > 0);
    BOOST_TEST(table.value(row, "ratio") == table.value(row, "stock_s") / seconds);
  }
}

BOOST_AUTO_TEST_CASE(several_pairs_of_runs_are_one_row) {
  const Compared compared(
      "pendulum", {"--until", "0.2", "--methods", "ida", "--rtol", "1e-4", "--repeats", "5"});
  const Table& table = compared.table;
  BOOST_TEST_REQUIRE(table.rows.size() == 1u);
  BOOST_TEST(table.text(0, "scene") == "pendulum");
  BOOST_TEST(table.value(0, "ratio") > 0);
  BOOST_TEST(table.value(0, "stock_s") > 0);
}

BOOST_AUTO_TEST_CASE(a_sidecar_says_how_it_was_made) {
  BOOST_TEST(listing(all_pairs().folder / "out") == "reference.json structure.csv structure.json ");
  const auto json = nlohmann::json::parse(read_all(all_pairs().folder / "out/structure.json"));
  for (const char* key : {"command_line", "scene", "version", "compiler", "flags", "cpu",
                          "libraries", "date", "until"}) {
    BOOST_TEST(json.contains(key), key);
  }
  BOOST_TEST(json.at("until") == 0.05);
}

BOOST_AUTO_TEST_CASE(the_tolerances_are_those_of_work_precision) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", chain);
  BOOST_TEST_REQUIRE(
      run("work_precision", {"--scene", scene, "--methods", "arkode_dirk4,ida", "--point-limit",
                             "1", "--repeats", "1", "--out", folder / "out"})
          .status == 0);
  const Table points = read_csv(folder / "out/points.csv");
  const Table& table = all_pairs().table;
  int compared = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    for (std::size_t point = 0; point < points.rows.size(); ++point) {
      if (points.text(point, "method") != table.text(row, "method")) continue;
      // Powers of ten as they are computed and as they are read.
      if (std::abs(points.value(point, "value") / table.value(row, "rtol") - 1) > 1e-14) continue;
      BOOST_TEST(points.value(point, "steps") == table.value(row, "steps"));
      ++compared;
    }
  }
  BOOST_TEST(compared == 4);
}

BOOST_AUTO_TEST_CASE(a_run_that_fails_has_its_reason_and_no_times) {
  const Compared compared(chain, {"--methods", "arkode_dirk2", "--rtol", "1e-15,1e-3", "--until",
                                  "0.01", "--point-limit", "0.05"});
  const Table& table = compared.table;
  BOOST_TEST_REQUIRE(table.rows.size() == 2u);
  // Steps of an error of third order: some hundred thousand.
  BOOST_TEST(table.text(0, "outcome") == "over_budget");
  BOOST_TEST(table.text(0, "stock_outcome") == "over_budget");
  for (const char* column : {"structured_s", "stock_s", "ratio", "structured_error", "stock_error",
                             "structured_force", "structured_rest", "stock_rest"}) {
    BOOST_TEST(table.text(0, column) == "", column);
  }
  BOOST_TEST(table.text(1, "outcome") == "reached_end");
}

BOOST_AUTO_TEST_CASE(negative_control_a_finer_tolerance_has_another_error) {
  const Table& table = all_pairs().table;
  for (std::size_t row = 0; row < table.rows.size(); row += 2) {
    const double coarse = table.value(row, "structured_error");
    BOOST_TEST(std::abs(table.value(row + 1, "stock_error") / coarse - 1) > 0.05);
    BOOST_TEST(table.value(row + 1, "steps") != table.value(row, "stock_steps"));
  }
}

BOOST_AUTO_TEST_SUITE_END()
