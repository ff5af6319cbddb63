#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "qddot/integrators/registry.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(work_precision_usage)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

// The last of an option counts, so that `more` may overrule what stands before.
Exit measure(const std::string& out, const Words& more) {
  Words words = {"--methods", "verlet", "--point-limit", "0.05", "--repeats", "1", "--out", out};
  words.insert(words.end(), more.begin(), more.end());
  return run("work_precision", words);
}

const std::string pinned =
    "dimension = 2\nuntil = 0.5\n"
    "nodes = [{position = [0, 0], pinned = true}, {position = [1, 0], pinned = true}]\n"
    "springs = [{nodes = [0, 1], stiffness = 10}]\n";

// A run's reference.json, and what it says after a mark was put in it and a second run followed.
struct Cache {
  Folder folder{};
  std::string file = folder / "reference.json";

  Cache() {
    BOOST_TEST_REQUIRE(run_on("orbit", "0.1").status == 0);
    mark();
  }
  // Its time is that of no file that is written now.
  void mark() const { std::filesystem::last_write_time(file, {}); }
  Exit run_on(const std::string& scene, const std::string& until) const {
    return measure(folder.path(), {"--scene", scene, "--until", until});
  }
  void write(const std::string& text) const {
    folder.write("reference.json", text);
    mark();
  }
  nlohmann::json json() const { return nlohmann::json::parse(read_all(file)); }
  bool is_marked() const {
    return std::filesystem::last_write_time(file) == std::filesystem::file_time_type{};
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(where_all_is_pinned_every_method_is_exact) {
  const Folder folder;
  const std::string scene = folder.write("s.toml", pinned);
  const Exit result = run("work_precision", {"--scene", scene, "--point-limit", "0.05", "--repeats",
                                             "1", "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0);
  const Table points = read_csv(folder / "out/points.csv");
  BOOST_TEST(points.rows.size() >= methods().size());
  for (std::size_t row = 0; row < points.rows.size(); ++row) {
    BOOST_TEST(points.text(row, "outcome") == "reached_end");
    BOOST_TEST(points.value(row, "error_position") == 0);
  }
}

BOOST_AUTO_TEST_CASE(a_scenes_name_is_quoted_where_it_must_be) {
  const Folder folder;
  const std::string scene =
      folder.write("s.toml",
                   "name = 'a, \"b\"'\ndimension = 1\nuntil = 0.1\n"
                   "nodes = [{position = [0], pinned = true}, {position = [1], mass = 1}]\n"
                   "springs = [{nodes = [0, 1], stiffness = 1, rest_length = 0}]\n");
  BOOST_TEST_REQUIRE(measure(folder / "out", {"--scene", scene}).status == 0);
  for (const char* name : {"out/points.csv", "out/front.csv"}) {
    const Table table = read_csv(folder / name);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      BOOST_TEST(table.text(row, "scene") == "a, \"b\"");
    }
  }
}

BOOST_AUTO_TEST_CASE(the_same_motion_takes_the_reference_that_is_there) {
  const Cache cache;
  const std::string before = read_all(cache.file);
  BOOST_TEST(cache.run_on("orbit", "0.1").status == 0);
  BOOST_TEST(read_all(cache.file) == before);
}

BOOST_AUTO_TEST_CASE(another_horizon_or_scene_makes_it_anew) {
  for (const auto& [scene, until] : {std::pair("orbit", "0.2"), std::pair("pair", "0.1")}) {
    const Cache cache;
    BOOST_TEST(cache.run_on(scene, until).status == 0);
    BOOST_TEST(!cache.is_marked());
    BOOST_TEST(cache.json().at("t") == number(until));
  }
}

BOOST_AUTO_TEST_CASE(a_damaged_reference_is_made_anew) {
  const Cache cache;
  const auto good = cache.json();
  const auto without = [&](const char* key) {
    auto json = good;
    json.erase(key);
    return json.dump();
  };
  const auto with = [&](const char* key, const nlohmann::json& value) {
    auto json = good;
    json[key] = value;
    return json.dump();
  };
  for (const std::string& text :
       {std::string(), good.dump().substr(0, 300), without("q"), without("key"),
        without("certified_position"), with("scales", nullptr), with("energy", "much"),
        with("q", {1, nullptr, 2}), with("v", "none"), with("q", {1, 2, 3}),
        with("v", nlohmann::json::array())}) {
    cache.write(text);
    const Exit result = cache.run_on("orbit", "0.1");
    BOOST_TEST(result.status == 0, text << " gives " << result.err);
    BOOST_TEST(!cache.is_marked(), "taken as it is: " << text);
    BOOST_TEST(cache.json().at("q").size() == 2u);
  }
}

BOOST_AUTO_TEST_CASE(a_reference_of_another_hand_is_not_replaced) {
  const Cache cache;
  for (const char* text : {"{", "[]", "my notes"}) {
    cache.write(text);
    const Exit result = cache.run_on("orbit", "0.1");
    BOOST_TEST(result.status == 2, result.err);
    BOOST_TEST(contains(result.err, {"reference.json", "--force"}), result.err);
    BOOST_TEST(read_all(cache.file) == text);
  }
}

BOOST_AUTO_TEST_CASE(negative_control_a_mark_stays_only_where_nothing_is_made) {
  const Cache cache;
  BOOST_TEST(cache.is_marked());
  std::filesystem::remove(cache.file);
  BOOST_TEST(cache.run_on("orbit", "0.1").status == 0);
  BOOST_TEST(!cache.is_marked());
}

BOOST_AUTO_TEST_SUITE_END()
