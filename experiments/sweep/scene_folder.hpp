#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/task_files.hpp"

namespace qddot::sweep {

// One scene's tasks that are whole, on one kind of machine, and where their tables go.
struct ScenePart {
  std::string out;  // its folder
  std::vector<Task> tasks{};
  nlohmann::json machine{};  // of the points
};

// Lets the program make its tables from the results of the tasks, as if it had measured all by
// itself. `by_work`: whether times are counts times costs on this machine. Returns why that failed;
// empty on success. Throws CannotWrite.
std::string make_tables(const TaskFiles& files, const ScenePart& part, bool by_work);

// Draws the program's picture of the folder and, of work_precision, its page. Empty, or why that
// failed.
std::string draw(const ScenePart& part);

// Runs a script of the project's Python on a folder. Empty, or why that failed.
std::string run_script(const std::string& script, const std::string& folder);

}  // namespace qddot::sweep
