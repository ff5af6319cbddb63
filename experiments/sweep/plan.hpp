#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/study_file.hpp"
#include "experiments/sweep/task.hpp"

namespace qddot::sweep {

// The most tasks of a sweep.
inline constexpr std::size_t most_tasks = 1000000;

// The tasks of the study of a file, scene by scene: what its program
// says of each scene that it can measure apart. Writes scene files that the study asks for into
// `folder`/scenes. Throws InvalidInput, in the program's own words, where it takes a scene, a
// method or an option not, and where there would be too many.
std::vector<Task> plan(const StudyFile& study, const std::string& study_path,
                       const std::string& folder);

}  // namespace qddot::sweep
