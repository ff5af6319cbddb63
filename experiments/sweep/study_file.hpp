#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace qddot::sweep {

// One scene of a study, to one horizon.
struct StudyScene {
  std::string label;   // of its folder, unlike all others
  std::string source;  // what --scene takes: a generator's name, or a file from the study's folder
  std::string text;    // of a scene file that is to be written in its place; may be empty
  double until = 0;    // [s]; 0: the scene's own
  std::size_t entry = 0;                   // of the list in the study's file
  std::map<std::string, double> varied{};  // what tells it from others of that entry
};

// A study for sweep, as a TOML file has it:
//
//   program = "work_precision"    # optional; or stability_map, energy_drift, crossover, advice
//   until = [0.1, 1]              # s; optional: each scene's own
//   methods = ["verlet", "ida"]   # optional: all
//   accuracies = [1e-2, 1e-4]     # optional, of work_precision: 1e-1 to 1e-9
//   scenes = [
//     "cloth", "my.toml",         # generators and files, from the study's folder
//     { generator = "chain", nodes = [100, 1000], stiffness = [1e4, 1e6] },  # lists multiply
//     { generator = "chain", stiffness = { from = 1, to = 1e6, count = 7, spacing = "log" } },
//     { generator = "chain", stiffness = { from = 1, to = 1e6 }, draws = 20, seed = 1 },
//     { file = "my.toml", until = 0.5 },
//   ]
//   [options]                     # optional: what the program takes, without dashes
//   point-limit = 0.5
//
// Programs that draw their own scenes (crossover, advice) take no scenes, and `until` as an option.
struct StudyFile {
  std::string program = "work_precision";
  std::vector<std::string> methods{};
  std::vector<double> accuracies{};
  std::vector<StudyScene> scenes{};                            // with one label each
  std::vector<std::pair<std::string, std::string>> options{};  // without dashes, and the value
};

inline constexpr double most_scenes = 100000;

// Reads a study. Throws InvalidInput for an unknown key or program, an empty list, or more than
// `most_scenes` scenes. The sentence names file, line, field, value and what is allowed.
StudyFile read_study(const std::string& path);

}  // namespace qddot::sweep
