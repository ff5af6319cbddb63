#pragma once

#include <string>

#include "src/scene/scene.hpp"

namespace qddot {

// Reads a scene from a TOML file: [[nodes]] and [[springs]], or a [mesh], or a [generator] table.
// Throws InvalidInput with one sentence that names file, line, entry, field, value and what is
// allowed; unknown keys are errors.
Scene read_scene(const std::string& path);

// The scene that a user names on a command line: a generator's name, else a file's path.
// Throws InvalidInput as read_scene does, and for a name that is neither.
Scene load_scene(const std::string& name_or_path);

}  // namespace qddot
