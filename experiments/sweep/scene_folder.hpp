#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/task_files.hpp"

namespace qddot::sweep {

// The whole tasks of one scene on one kind of machine, and the folder for their tables.
struct SceneTasks {
  std::string out;  // its folder
  std::vector<Task> tasks{};
  nlohmann::json machine{};  // of the points
};

// Lets the program make its tables from the results of the tasks, as if it had measured all by
// itself. `by_work`: whether times are counts times costs on this machine. Returns why that failed;
// empty on success. Throws CannotWrite.
std::string make_tables(const TaskFiles& files, const SceneTasks& part, bool by_work);

// Draws the program's picture of the folder and, of work_precision, its page. Empty, or why that
// failed. Scripts need the environment that set_environment_of_scripts() gives this process.
std::string draw(const SceneTasks& part);
void set_environment_of_scripts();

// Runs a script of the project's Python on a folder. Empty, or why that failed.
std::string run_script(const std::string& script, const std::string& folder);

}  // namespace qddot::sweep
