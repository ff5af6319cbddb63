#pragma once

#include <string>

#include <toml++/toml.h>

namespace qddot {

// Parses the TOML text of the file `path`. Throws InvalidInput with file, line and column if it is
// not TOML, or if its keys are nested deeper than the parser bears.
toml::table parse_toml(const std::string& text, const std::string& path);

}  // namespace qddot
