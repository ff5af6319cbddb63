#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/task_files.hpp"

namespace qddot::sweep {

// Prints by stage how many tasks of a sweep are done, running, begun but ended, failed and missing.
// Prints which failed and why, and the expected time of the rest. Returns the exit status.
int print_status(const std::string& folder);

// Writes what is missing of a sweep to `folder`/missing.csv, and the first of it to stdout: scene,
// share, cause, and the command that measures it. Points whose reference cannot be made have no
// command. Returns whether nothing is missing.
bool report_missing(const std::string& folder, const std::vector<Task>& tasks,
                    const std::vector<TaskState>& states);

}  // namespace qddot::sweep
