#pragma once

#include <string>

namespace qddot::sweep {

// Prints by stage how many tasks of a sweep are done, running, begun but ended, failed and missing.
// Prints which failed and why, and the expected time of the rest. Returns the exit status.
int print_status(const std::string& folder);

}  // namespace qddot::sweep
