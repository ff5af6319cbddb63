#pragma once

#include <string>

namespace qddot::command {

// What outputs may replace: nothing that the program has read, and no file that somebody else wrote
// unless the user says so (--force).

// From now on no output may go to the place of this file, which was read.
void protect_input(const std::string& path);
// From now on files of others may be replaced.
void allow_replacing();

// Throws InvalidInput, which names the place, if an output may not go there. Replaceable are files
// that are empty, that begin with `beginning` (a table's own header row), whose sidecar `sidecar`
// says that qddot wrote it, or that say so themselves.
void require_replaceable(const std::string& path, const std::string& beginning = {},
                         const std::string& sidecar = {});

// A text with a line before it, a comment in TOML, by which qddot knows it again as its own as long
// as nobody changes it.
std::string signed_text(const std::string& text);

}  // namespace qddot::command
