#pragma once

#include <filesystem>

#include "qddot/scene/scene.hpp"
#include "qddot/scene/scene_limits.hpp"
#include "qddot/scene/text_file.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot {

// The nodes, springs and faces of a scene file's [mesh] table, in three dimensions: every edge a
// spring at its own length, every vertex at which one ends a node, in the order of the file, and
// pinned where it lies in a [[mesh.pin]] box (in scaled coordinates [m]). Other vertices are left
// out, with a warning. The mesh file is sought from `folder` and its text taken from `read`. Throws
// InvalidInput for a mesh without edges and a box without vertices as for any other mistake.
void add_mesh(const TomlTable& table, const std::filesystem::path& folder, const TextSource& read,
              const SceneLimits& limits, Scene& scene);

}  // namespace qddot
