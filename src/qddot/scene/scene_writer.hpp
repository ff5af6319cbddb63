#pragma once

#include <string>

#include "qddot/scene/scene.hpp"
#include "qddot/scene/text_file.hpp"

namespace qddot {

// The scene as the text of a scene file of nodes and springs. Read back, it gives the same scene to
// the last bit of every number. The scene must be valid and have a node. Bytes of its name that are
// no UTF-8, which TOML cannot hold, are written as U+FFFD. Throws InvalidInput if the text would
// have more than `most` bytes, and so could not be read back.
std::string to_toml(const Scene& scene, std::size_t most = most_bytes);

}  // namespace qddot
