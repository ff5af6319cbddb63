#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/task_files.hpp"

namespace qddot::sweep {

// What there is not of a sweep, into `folder`/missing.csv and, the first of it, to stdout: scene,
// share, why, and the command that measures it. Points whose reference cannot be made have none.
// True where nothing is missing.
bool report_missing(const std::string& folder, const std::vector<Task>& tasks,
                    const std::vector<TaskState>& states);

}  // namespace qddot::sweep
