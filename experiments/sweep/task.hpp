#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/sweep/child.hpp"

namespace qddot::sweep {

// A share of the study of one scene, which one process measures by itself.
struct Task {
  std::string id;       // 16 hexadecimal digits, see id_of
  std::string stage;    // references or points
  std::string folder;   // of the scene's results, in that of the sweep
  std::string program;  // by its name
  std::string share;
  std::vector<std::string> arguments;      // of the program, but for --out, --share and --journal
  nlohmann::json key;                      // of the study, see Study
  std::map<std::string, double> varied{};  // what tells the scene from others of its entry
  std::size_t entry = 0;                   // of the list of scenes
  std::size_t order = 0;                   // scene by scene and, of each, as its program says
};

inline const std::string references = "references", points = "points";

// The hash, 16 hexadecimal digits, of all that decides the results of a share: scene, end time,
// method, options, code, compiler and flags. The machine is not part of it; it decides only the
// times.
std::string id_of(nlohmann::json key, const std::string& share);

// All tasks in the order of measurement: references first, and each stage by its ids, which is a
// random order. So no shard gets all tasks of one scene or method, and finished tasks predict the
// time of the rest without bias. Throws InvalidInput, which names file and line, if
// `folder`/tasks.jsonl is missing or damaged, or was planned by other code.
std::vector<Task> read_tasks(const std::string& folder);
// Writes them in that order, a line each.
void write_tasks(const std::string& folder, std::vector<Task> tasks);

// The command of a task that writes into the journal.
Command command_of(const Task& task, const std::string& folder, const std::string& journal);

}  // namespace qddot::sweep
