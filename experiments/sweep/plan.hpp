#pragma once

#include <string>

namespace qddot::sweep {

// Plans the study of a file: writes its tasks, and scene files that it asks for, into the folder
// `out`, and prints how many there are. Returns the exit status. Throws InvalidInput, in the
// program's own words, if it does not take a scene, a method or an option, and if there would be
// too many tasks.
int plan(const std::string& study_path, const std::string& out);

}  // namespace qddot::sweep
