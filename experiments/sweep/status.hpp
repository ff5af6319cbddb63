#pragma once

#include <string>

namespace qddot::sweep {

// Prints what of a sweep is done, running, begun and ended, failed and missing, by stage, what
// failed and why, and how long the rest takes, by what is done. Returns the program's status.
int print_status(const std::string& folder);

}  // namespace qddot::sweep
