#include <cmath>
#include <filesystem>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

// The record of a chart, chart.json, and how it is made anew from tables.
BOOST_AUTO_TEST_SUITE(judge)

using namespace qddot;

namespace {

// A finished measurement.
const Folder& measured() {
  static const Folder folder;
  static const Exit result =
      run("work_precision",
          {"--scene", "oscillator", "--until", "2", "--methods", "verlet,rk4,ida,implicit_midpoint",
           "--point-limit", "0.05", "--repeats", "1", "--out", folder.path()});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  return folder;
}

// A copy of the measurement without its record.
struct Copy {
  Folder folder{};

  Copy() {
    for (const char* name : {"points.csv", "points.json", "front.csv", "reference.json"})
      std::filesystem::copy(measured() / name, folder / name);
  }
  void remove(const char* name) const { std::filesystem::remove(folder / name); }
  Exit judge() const { return run("work_precision", {"--judge", folder.path()}); }
  nlohmann::json chart() const { return nlohmann::json::parse(read_all(folder / "chart.json")); }
};

nlohmann::json chart_of_measured() {
  return nlohmann::json::parse(read_all(measured() / "chart.json"));
}

// The numbers of the points of the judged front; -1 where there is none.
std::vector<int> front_of(const nlohmann::json& chart) {
  std::vector<int> points;
  for (const auto& row : chart.at("rows"))
    points.push_back(row.at("point").is_null() ? -1 : row.at("point").get<int>());
  return points;
}

void check_refused(const Copy& copy, const std::vector<std::string>& fragments) {
  const Exit result = copy.judge();
  BOOST_TEST(result.status == 2);
  BOOST_TEST(contains(result.err, fragments), result.err);
  BOOST_TEST(!std::filesystem::exists(copy.folder / "chart.json"));
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_record_has_the_front_of_the_table) {
  const auto chart = chart_of_measured();
  const Table points = read_csv(measured() / "points.csv");
  const Table front = read_csv(measured() / "front.csv");
  BOOST_TEST(chart.at("knobs").size() == points.rows.size());
  BOOST_TEST(chart.at("judged_by") == "position");
  BOOST_TEST(chart.at("scene") == "oscillator");
  BOOST_TEST_REQUIRE(chart.at("rows").size() == front.rows.size());
  std::size_t filled = 0;
  for (std::size_t i = 0; i < front.rows.size(); ++i) {
    const auto& row = chart.at("rows").at(i);
    BOOST_TEST(row.at("accuracy").get<double>() == front.value(i, "accuracy"));
    BOOST_TEST(row.at("point").is_null() == front.text(i, "method").empty());
    BOOST_TEST(row.at("why_empty").is_null() != row.at("point").is_null());
    if (row.at("point").is_null()) continue;
    ++filled;
    const std::size_t point = row.at("point");
    for (const char* column : {"scene", "method", "knob", "value", "error_position", "time_s"})
      BOOST_TEST(points.text(point, column) == front.text(i, column));
    const std::string margin = front.text(i, "stability_margin");
    BOOST_TEST(row.at("margin").is_null() == margin.empty());
    if (!margin.empty()) BOOST_TEST(row.at("margin").get<double>() == std::stod(margin));
  }
  BOOST_TEST(filled >= 5u);
}

BOOST_AUTO_TEST_CASE(it_is_made_anew_from_the_tables) {
  const Copy copy;
  const Exit result = copy.judge();
  BOOST_TEST(result.status == 0, result.err);
  const auto made = copy.chart(), measured = chart_of_measured();
  for (const char* part :
       {"judged_by", "scene", "until", "certified", "accuracies", "caveats", "displacements",
        "knobs", "times", "quantities", "staircases", "crossings"}) {
    BOOST_TEST((made.at(part) == measured.at(part)), part);
  }
  // Margins come from a margin in front.csv, and back.
  for (std::size_t i = 0; i < made.at("margins").size(); ++i) {
    const auto &one = made.at("margins")[i], &other = measured.at("margins")[i];
    BOOST_TEST_REQUIRE(one.is_null() == other.is_null());
    if (!one.is_null()) BOOST_TEST(std::abs(one.get<double>() - other.get<double>()) < 1e-12);
  }
  BOOST_TEST(front_of(made) == front_of(measured), boost::test_tools::per_element());
  BOOST_TEST(copy.judge().status == 0);  // it replaces its own
}

BOOST_AUTO_TEST_CASE(points_alone_say_what_their_bounds_say) {
  const Copy copy;
  for (const char* name : {"points.json", "front.csv", "reference.json"}) copy.remove(name);
  BOOST_TEST(copy.judge().status == 0);
  const auto chart = copy.chart(), measured = chart_of_measured();
  BOOST_TEST(chart.at("certified").get<double>() == measured.at("certified").get<double>(),
             boost::test_tools::tolerance(1e-2));
  BOOST_TEST(chart.at("scene") == "oscillator");
  BOOST_TEST(front_of(chart) == front_of(measured), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(folders_that_cannot_be_read_are_refused_in_a_sentence) {
  Copy copy;
  copy.folder.write("front.csv", "accuracy,method,value,stability_margin\n2,verlet,0.1,\n");
  check_refused(copy, {"front.csv", "row 1", "'2'"});
  copy.folder.write("front.csv", "scene\n");
  check_refused(copy, {"front.csv", "accuracy"});
  copy.remove("front.csv");
  copy.folder.write("reference.json", "{");
  check_refused(copy, {"reference.json"});
  copy.folder.write("reference.json", R"({"certified_position": "small"})");
  check_refused(copy, {"reference.json"});
  copy.remove("reference.json");
  copy.folder.write("points.csv", "scene\n");
  check_refused(copy, {"points.csv", "method"});
  copy.remove("points.csv");
  check_refused(copy, {"points.csv"});
}

BOOST_AUTO_TEST_CASE(it_measures_nothing_and_takes_no_other_options) {
  const Copy copy;
  const Exit result =
      run("work_precision", {"--judge", copy.folder.path(), "--scene", "oscillator"});
  BOOST_TEST(result.status == 2);
  BOOST_TEST(contains(result.err, {"--scene", "--judge"}), result.err);
  copy.folder.write("chart.json", "{\"mine\": 1}\n");
  BOOST_TEST(copy.judge().status == 2);  // somebody else's
  BOOST_TEST(read_all(copy.folder / "chart.json") == "{\"mine\": 1}\n");
}

BOOST_AUTO_TEST_SUITE_END()
