#pragma once

#include <filesystem>
#include <string>

#include "qddot/scene/scene.hpp"
#include "qddot/scene/scene_limits.hpp"
#include "qddot/scene/text_file.hpp"

namespace qddot {

// Reads a scene from a TOML file: [[nodes]] and [[springs]], or a [mesh], or a [generator] table.
// Throws InvalidInput with one sentence that names file, line, entry, field, value and what is
// allowed; unknown keys are errors.
Scene read_scene(const std::string& path);

// The same for a text in memory, as if the file `path` held it. Meshes are sought in `folder` and
// read by `read`. A scene larger than the limits is refused before it is made.
Scene parse_scene(const std::string& text, const std::string& path,
                  const std::filesystem::path& folder, const SceneLimits& limits = {},
                  const TextSource& read = read_text);

// The scene that a user names on a command line: a generator's name, else a file's path. Throws
// InvalidInput as read_scene does, and for a name that is neither. `read` reads all files.
Scene load_scene(const std::string& name_or_path, const TextSource& read = read_text,
                 const SceneLimits& limits = {});

// The scene as the text of a scene file of nodes and springs. Read back, it gives the same scene to
// the last bit of every number. The scene must be valid and have a node. Bytes of its name that are
// no UTF-8, which TOML cannot hold, are written as U+FFFD. Throws InvalidInput if the text would
// have more than `most` bytes, and so could not be read back.
std::string to_toml(const Scene& scene, std::size_t most = most_bytes);

}  // namespace qddot
