#pragma once

#include <filesystem>

#include "src/scene/scene.hpp"
#include "src/scene/scene_limits.hpp"
#include "src/scene/text_file.hpp"
#include "src/scene/toml_table.hpp"

namespace qddot {

// The nodes and springs of a scene file's [mesh] table, in three dimensions: every vertex a node,
// every edge a spring at its own length, vertices in the [[mesh.pin]] boxes pinned. The mesh file
// is sought from `folder` and its text taken from `read`.
void add_mesh(const Table& table, const std::filesystem::path& folder, const TextSource& read,
              const SceneLimits& limits, Scene& scene);

}  // namespace qddot
