#pragma once

#include <string>

namespace qddot::inline kit {

// The files that outputs may replace. A file that the program has read is never replaced, and a
// file that qddot did not write only with --force.

// Protects a file that was read: no output may replace it from now on.
void protect_input(const std::string& path);
// Allows outputs to replace files that qddot did not write.
void allow_replacing();

// Throws InvalidInput, which names the path, if an output may not replace that file. Replaceable
// are empty files, files that begin with `beginning` (a table's own header row), and files that
// qddot wrote as their sidecar `sidecar` or their own text says.
void require_replaceable(const std::string& path, const std::string& beginning = {},
                         const std::string& sidecar = {});

// The text after a line, a comment in TOML, by which qddot recognises it as its own while nobody
// changes it.
std::string signed_text(const std::string& text);

}  // namespace qddot::inline kit
