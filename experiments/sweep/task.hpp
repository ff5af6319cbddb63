#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/sweep/child.hpp"

namespace qddot::sweep {

// What one process measures by itself: a share of the study of one scene.
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

// The content hash of a share of a study: of all that decides what it measures (scene, horizon,
// method, options, code, compiler and flags), as 16 hexadecimal digits; not of the machine, which
// decides how long that takes.
std::string id_of(nlohmann::json key, const std::string& share);

// All tasks in the order in which they are measured: those of references first and each stage by
// the ids, which is at random. No shard then gets one scene's tasks, or one method's, and those
// that are done say without bias how long the rest takes. Throws InvalidInput, naming file and
// line, where `folder`/tasks.jsonl is missing or not as it was written, or was planned by other
// code than this.
std::vector<Task> read_tasks(const std::string& folder);
// Writes them in that order, a line each.
void write_tasks(const std::string& folder, std::vector<Task> tasks);

// The command of a task that writes into the journal.
Command command_of(const Task& task, const std::string& folder, const std::string& journal);

}  // namespace qddot::sweep
