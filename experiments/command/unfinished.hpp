#pragma once

#include <string>

namespace qddot::command {

// Files that are being written beside their places. Each is named X.PID.part and locked (flock) by
// the process that writes it, so that it is known to be stale once nobody holds the lock.

// Opens X.PID.part, empty, locked and written down as unfinished; a negative number with errno set
// where that cannot be done. Removes the stale ones in the same folder.
int open_unfinished(const std::string& path);
// The name that open_unfinished gives a file for the place `path`.
std::string unfinished_name(const std::string& path);
// It is unfinished no longer: it was renamed or removed.
void forget_unfinished(const std::string& name);
// Removes all unfinished files of this process, which is about to end.
void remove_unfinished();

}  // namespace qddot::command
