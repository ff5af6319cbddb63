#include <cmath>
#include <filesystem>
#include <map>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(motions)

using namespace qddot;

namespace {

// A chart of a pendulum with runs that diverge, made once, and its motions.
struct Kept {
  Folder folder{};
  Exit measured =
      run("work_precision", {"--scene", "pendulum", "--until", "1", "--methods",
                             "explicit_euler,verlet,kahan_li8,discrete_gradient,ida",
                             "--point-limit", "0.3", "--repeats", "1", "--out", folder.path()});
  Table points = read_csv(folder / "points.csv");
  nlohmann::json reference = nlohmann::json::parse(read_all(folder / "reference.json"));
  Exit result = keep({"--frames", "40", "--runs", "1000"});
  Table motions = read_csv(folder / "motions.csv");
  Table energy = read_csv(folder / "motions_energy.csv");

  Exit keep(std::vector<std::string> more) const {
    more.insert(more.begin(), {"--scene", "pendulum", "--out", folder.path()});
    return run("motions", more);
  }
};

const Kept& kept() {
  static const Kept made;
  return made;
}

// The row of points.csv that a row of motions.csv shows.
std::size_t row_of_points(std::size_t motion) {
  const Kept& k = kept();
  for (std::size_t row = 0; row < k.points.rows.size(); ++row) {
    if (k.points.text(row, "method") == k.motions.text(motion, "method") &&
        k.points.text(row, "value") == k.motions.text(motion, "value")) {
      return row;
    }
  }
  throw std::runtime_error("no such point");
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_run_that_ended_in_time_has_a_motion_and_the_reference_comes_first) {
  const Kept& k = kept();
  BOOST_TEST(k.result.status == 0, k.result.err);
  BOOST_TEST(k.motions.text(0, "role") == "reference");
  std::size_t in_time = 0;
  for (std::size_t row = 0; row < k.points.rows.size(); ++row) {
    in_time += k.points.text(row, "outcome") != "over_budget";
  }
  BOOST_TEST(k.motions.rows.size() == in_time + 1);
  for (std::size_t row = 0; row < k.motions.rows.size(); ++row) {
    const std::string file = k.folder / k.motions.text(row, "file");
    BOOST_TEST(std::filesystem::exists(file), file);
    if (row > 0) BOOST_TEST(k.motions.text(row, "role") == "run");
  }
}

BOOST_AUTO_TEST_CASE(a_run_is_the_one_of_the_chart) {
  const Kept& k = kept();
  for (std::size_t row = 1; row < k.motions.rows.size(); ++row) {
    const std::size_t point = row_of_points(row);
    BOOST_TEST(k.motions.text(row, "outcome") == k.points.text(point, "outcome"));
    BOOST_TEST(k.motions.text(row, "t_reached") == k.points.text(point, "t_reached"));
    const bool is_good = k.points.text(point, "outcome") == "reached_end";
    if (is_good) {
      // IDA's steps end at the frames: it has few of these and still takes other steps.
      if (k.motions.text(row, "method") == "ida") {
        BOOST_TEST(4 * (k.motions.value(row, "frames") - 1) <=
                   std::max(4.0, k.points.value(point, "steps")));
        continue;
      }
      BOOST_TEST(k.motions.value(row, "frames") == 41);
    } else {
      BOOST_TEST(k.motions.value(row, "frames") <=
                 1 + 40 * k.points.value(point, "t_reached") + 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(energies_are_those_of_the_chart) {
  const Kept& k = kept();
  std::map<std::string, std::vector<std::size_t>> rows;
  for (std::size_t row = 0; row < k.energy.rows.size(); ++row) {
    rows[k.energy.text(row, "file")].push_back(row);
    BOOST_TEST(k.energy.value(row, "total") ==
               k.energy.value(row, "kinetic") + k.energy.value(row, "potential"));
  }
  const double kinetic = k.reference.at("scales").at("kinetic");
  for (std::size_t row = 1; row < k.motions.rows.size(); ++row) {
    const auto& own = rows[k.motions.text(row, "file")];
    BOOST_TEST(static_cast<double>(own.size()) <= k.motions.value(row, "frames"));
    const std::size_t point = row_of_points(row);
    if (k.points.text(point, "outcome") != "reached_end") continue;
    if (static_cast<double>(own.size()) < k.motions.value(row, "frames")) continue;
    const double drift =
        std::abs(k.energy.value(own.back(), "total") - k.energy.value(own.front(), "total"));
    const double error = k.points.value(point, "error_energy");
    // SUNDIALS' method ends steps at the frames, and so takes other steps than on the chart. The
    // energies of the other methods are sums of a few terms of size `kinetic`, each rounded.
    if (k.motions.text(row, "method") == "ida") continue;
    BOOST_TEST(std::abs(drift / kinetic - error) <= 1e-13 + 1e-9 * error);
  }
}

BOOST_AUTO_TEST_CASE(seconds_are_told_by_phase) {
  const Kept& k = kept();
  for (std::size_t row = 1; row < k.motions.rows.size(); ++row) {
    const double all = k.motions.value(row, "seconds");
    const double parts =
        k.motions.value(row, "seconds_force") + k.motions.value(row, "seconds_stiffness") +
        k.motions.value(row, "seconds_factorization") + k.motions.value(row, "seconds_solve");
    BOOST_TEST(all > 0);
    BOOST_TEST(parts <= all);
  }
}

BOOST_AUTO_TEST_CASE(fewer_runs_take_the_place_of_more) {
  const Kept own;
  BOOST_TEST(own.keep({"--runs", "2", "--frames", "3"}).status == 0);
  const Table motions = read_csv(own.folder / "motions.csv");
  BOOST_TEST_REQUIRE(motions.rows.size() == 3);
  std::string expected;
  std::vector<std::string> names;
  for (std::size_t row = 0; row < 3; ++row) {
    BOOST_TEST(motions.value(row, "frames") == 4);
    const std::string stem = motions.text(row, "file").substr(8);
    for (const char* ending : {"vtkhdf", "vtkhdf.json", "xdmf"}) {
      names.push_back(stem.substr(0, stem.size() - 6) + ending);
    }
  }
  std::ranges::sort(names);
  for (const std::string& name : names) expected += name + ' ';
  BOOST_TEST(listing(own.folder / "motions") == expected);
}

BOOST_AUTO_TEST_CASE(only_motions_of_the_folder_are_replaced) {
  const Kept own;
  own.folder.write("mine.vtkhdf", "mine");
  const std::string table = read_all(own.folder / "motions.csv");
  const std::string row =
      table.substr(table.find('\n') + 1, table.find('\n', table.find('\n') + 1) - table.find('\n'));
  std::string spoiled = table;
  for (const char* other : {"mine.vtkhdf", "motions/../mine.vtkhdf", "motions/other.txt"}) {
    spoiled += other + row.substr(row.find(','));
  }
  own.folder.write("motions.csv", spoiled);
  BOOST_TEST(own.keep({"--runs", "1", "--frames", "2"}).status == 0);
  BOOST_TEST(read_all(own.folder / "mine.vtkhdf") == "mine");
  // A file that somebody else put in the place of a motion stays as well.
  const std::string first = read_csv(own.folder / "motions.csv").text(1, "file");
  for (const char* part : {"", ".json"}) std::filesystem::remove(own.folder / first + part);
  own.folder.write(first, "mine");
  const Exit refused = own.keep({"--runs", "1", "--frames", "2"});
  BOOST_TEST(refused.status == 2);
  BOOST_TEST(contains(refused.err, {first, "--force"}), refused.err);
  BOOST_TEST(read_all(own.folder / first) == "mine");
  BOOST_TEST(!std::filesystem::exists(own.folder / "motions.part"));
}

BOOST_AUTO_TEST_CASE(an_interruption_leaves_the_motions_of_before) {
  const Kept own;
  const std::string table = read_all(own.folder / "motions.csv");
  const std::string files = listing(own.folder / "motions");
  // So soon that no run is made, and whether the program has begun with them or not.
  for (const char* limit : {"1e-4", "0.05"}) {
    const Exit cut = own.keep({"--frames", "10000", "--time-limit", limit});
    BOOST_TEST(cut.status == 3, cut.out);
    BOOST_TEST(read_all(own.folder / "motions.csv") == table);
    BOOST_TEST(listing(own.folder / "motions") == files);
  }
}

BOOST_AUTO_TEST_CASE(the_reference_is_nearer_than_any_run) {
  const Kept& k = kept();
  const std::string why = k.motions.text(0, "why");
  const std::string words = "within ";
  BOOST_TEST_REQUIRE(why.starts_with(words));
  const double error = std::stod(why.substr(words.size()));
  // Rounding, or what the reference is certified to: runs of the chart come as near at the best.
  BOOST_TEST(error <= 10 * k.reference.at("certified_position").get<double>());
  for (std::size_t row = 1; row < k.motions.rows.size(); ++row) {
    const std::size_t point = row_of_points(row);
    if (k.points.text(point, "outcome") != "reached_end" || k.motions.text(row, "method") == "ida")
      continue;
    BOOST_TEST(k.motions.value(row, "largest_distance") >=
               k.points.value(point, "error_position") - 2 * error);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_said_in_a_sentence) {
  const Kept& k = kept();
  const auto refused = [](const Exit& exit, const std::vector<std::string>& fragments) {
    BOOST_TEST(exit.status == 2);
    BOOST_TEST(contains(exit.err, fragments), exit.err);
    BOOST_TEST(std::ranges::count(exit.err, '\n') == 1);
  };
  refused(run("motions", {"--scene", "orbit", "--out", k.folder.path()}),
          {"--scene orbit", "another scene"});
  refused(k.keep({"--frames", "0"}), {"--frames 0", "1 to 10000"});
  refused(k.keep({"--runs", "-1"}), {"--runs -1"});
  const Folder empty;
  refused(run("motions", {"--scene", "pendulum", "--out", empty.path()}),
          {"points.csv: it cannot be read"});
  empty.write("points.csv", read_all(k.folder / "points.csv"));
  refused(run("motions", {"--scene", "pendulum", "--out", empty.path()}),
          {"points.json: it is missing"});
  BOOST_TEST(empty.listing() == "points.csv ");
  // Numbers that nobody wrote.
  const auto spoiled = [&](const std::string& file, const std::string& from,
                           const std::string& to) {
    const Folder folder;
    for (const char* name : {"points.csv", "points.json"}) {
      std::string text = read_all(k.folder / name);
      if (file == name) text.replace(text.find(from), from.size(), to);
      folder.write(name, text);
    }
    return run("motions", {"--scene", "pendulum", "--out", folder.path()});
  };
  const std::string value = k.points.text(0, "value");
  refused(spoiled("points.csv", value, "-1"), {"row 1", "value -1"});
  refused(spoiled("points.csv", value, "nan"), {"row 1", "value"});
  refused(spoiled("points.json", "\"until\": 1.0", "\"until\": -3.0"), {"until"});
}

BOOST_AUTO_TEST_SUITE_END()
