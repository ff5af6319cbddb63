#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/kit/journal.hpp"
#include "tests/programs/process.hpp"

namespace qddot {
inline namespace tests {

// Two scenes, few methods, and runs short enough to be repeated often; which points are taken does
// not depend on how long they take.
inline const std::string small_study = R"(scenes = ["pendulum", { generator = "chain", nodes = 6 }]
until = 0.05
methods = ["verlet", "implicit_euler", "blanes_moan4", "ida"]
accuracies = [1e-2, 1e-4]
[options]
point-limit = 60
repeats = 1
)";

// A sweep in a fresh folder.
struct Sweep {
  explicit Sweep(const std::string& text = small_study) {
    study = folder.write("study.toml", text);
    planned = run("sweep", {"plan", study, "--out", out});
  }

  Exit go(const std::string& stage, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"run", out, "--stage", stage};
    words.insert(words.end(), more.begin(), more.end());
    return run("sweep", words);
  }
  // All of it, with tables.
  Exit go_and_merge() const {
    BOOST_TEST(go("references").status == 0);
    BOOST_TEST(go("points").status == 0);
    return merge();
  }
  Exit merge(const std::vector<std::string>& more = {"--no-pictures"}) const {
    std::vector<std::string> words = {"merge", out};
    words.insert(words.end(), more.begin(), more.end());
    return run("sweep", words);
  }
  std::vector<nlohmann::json> tasks() const {
    std::vector<nlohmann::json> all;
    std::istringstream lines(read_all(out + "/tasks.jsonl"));
    for (std::string line; std::getline(lines, line);) all.push_back(nlohmann::json::parse(line));
    return all;
  }
  nlohmann::json task(const std::string& scene, const std::string& share) const {
    for (const auto& one : tasks()) {
      if (one.at("folder") == scene && one.at("share") == share) return one;
    }
    throw std::runtime_error("no task " + share);
  }
  std::string whole(const nlohmann::json& one) const {
    return fmt::format("{}/tasks/whole/{}.journal", out, one.at("id").get<std::string>());
  }
  // The files of whole tasks and what they hold.
  std::map<std::string, std::string> measured() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(out + "/tasks/whole"))
      all[entry.path().filename().string()] = read_all(entry.path().string());
    return all;
  }
  // Writes a whole task's file anew, changed.
  template <class Change>
  void rewrite(const nlohmann::json& one, const Change& change) const {
    auto contents = kit::Journal::read(whole(one));
    change(contents);
    std::filesystem::remove(whole(one));
    kit::Journal journal(whole(one), contents.key, false);
    for (const auto& [name, value] : contents.pieces) journal.keep(name, value);
  }

  Folder folder{};
  std::string out = folder / "S", study;
  Exit planned;
};

// The rows of points.csv but for what differs from one measurement to the next.
inline std::multiset<std::vector<std::string>> untimed_points(const std::string& path) {
  const Table table = read_csv(path);
  std::multiset<std::vector<std::string>> rows;
  for (std::vector<std::string> row : table.rows) {
    for (const char* name : {"time_s", "time_min_s", "setup_s", "timed_runs"})
      row[table.column(name)].clear();
    rows.insert(row);
  }
  return rows;
}

// The same of small_study, each scene measured by one process.
inline const std::multiset<std::vector<std::string>>& points_of_one_process() {
  static const auto all = [] {
    const Folder folder;
    const std::string chain =
        folder.write("chain.toml", "[generator]\nkind = \"chain\"\nnodes = 6\n");
    std::multiset<std::vector<std::string>> rows;
    for (const std::string& scene : {std::string("pendulum"), chain}) {
      BOOST_TEST(run("work_precision",
                     {"--scene", scene, "--until", "0.05", "--methods",
                      "verlet,implicit_euler,blanes_moan4,ida", "--accuracies", "1e-2,1e-4",
                      "--point-limit", "60", "--repeats", "1", "--out", folder / "one"})
                     .status == 0);
      rows.merge(untimed_points(folder / "one/points.csv"));
    }
    return rows;
  }();
  return all;
}

// Merges the sweep of small_study. Nothing may be missing, and its points must be those of one
// process.
inline void check_as_one_process(const Sweep& sweep) {
  const Exit merged = sweep.merge();
  BOOST_TEST(merged.status == 0, merged.err);
  BOOST_TEST((untimed_points(sweep.out + "/points.csv") == points_of_one_process()));
}

}  // namespace tests
}  // namespace qddot
