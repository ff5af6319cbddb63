#pragma once

#include <string>

#include <toml++/toml.h>

namespace qddot {

// The TOML text of the file `path`. Throws InvalidInput with file, line and column where it is
// none, or where its keys are nested deeper than the parser bears.
toml::table parse_toml(const std::string& text, const std::string& path);

}  // namespace qddot
