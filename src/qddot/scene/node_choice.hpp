#pragma once

#include <span>
#include <vector>

#include "qddot/scene/curve_reader.hpp"
#include "qddot/scene/mesh/mesh.hpp"
#include "qddot/scene/scene.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot {

// The nodes that a table chooses, at least one and each once: `nodes` by their indices, those in
// the box from `min` to `max` [m], or those of a `group` of the mesh, by its name or tag;
// `dimension` is that of the group's elements, where it takes more to tell. Throws InvalidInput for
// any mistake.
std::vector<std::size_t> chosen_nodes(const TomlTable& choice, const Scene& scene,
                                      std::span<const mesh::Group> groups);

// Adds the loads of the tables `load` of a [mesh] or a [generator] to the scene's nodes: `force`
// [N] on each chosen node, or equal shares of `total_force` [N]; or the curve `force_in_time` [N]
// on each that is not pinned.
void add_loads(const TomlTable& source, std::span<const mesh::Group> groups,
               const CurveReader& curves, Scene& scene);

}  // namespace qddot
