#pragma once

#include <string>

namespace qddot::inline kit {

// Files that are being written beside their final names. Each is named X.PID.part and locked
// (flock) by the process that writes it. A file without a lock is stale.

// Opens an empty file X.PID.part, locks it and registers it as unfinished. Returns a negative
// number, with errno set, if that fails. Removes stale files of this kind in the same folder.
int open_unfinished(const std::string& path);
// The name that open_unfinished gives a file for the place `path`.
std::string unfinished_name(const std::string& path);
// Removes the name from the register: the file was renamed or removed.
void forget_unfinished(const std::string& name);
// Removes all unfinished files of this process, before it ends.
void remove_unfinished();

}  // namespace qddot::inline kit
