#pragma once

#include <filesystem>

#include "qddot/scene/curve_reader.hpp"
#include "qddot/scene/scene.hpp"
#include "qddot/scene/scene_limits.hpp"
#include "qddot/scene/text_file.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot {

// Adds the nodes, springs and faces of a scene file's [mesh] table, in three dimensions. Every edge
// is a spring at its own length. Every end of an edge is a node, in the order of the file. It is
// pinned if a [[mesh.pin]] chooses it, on the curve `motion` of that if it has one. It has the
// loads of each [[mesh.load]] that chooses it (see node_choice.hpp; boxes are in the scene's
// coordinates [m]). Other vertices are left out, with a warning; another one tells of parts that no
// edge joins. The mesh file is sought in `folder` and read by `read`. Throws InvalidInput for any
// mistake, also for a mesh without edges and a box without vertices.
void add_mesh(const TomlTable& table, const std::filesystem::path& folder, const TextSource& read,
              const SceneLimits& limits, const CurveReader& curves, Scene& scene);

}  // namespace qddot
