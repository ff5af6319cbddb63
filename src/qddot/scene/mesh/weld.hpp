#pragma once

#include "qddot/scene/mesh/mesh.hpp"

namespace qddot::mesh {

// For each vertex the first one that it is welded to: vertices within `distance` of each other, and
// chains of such, become one. A surface that was cut for its texture has such vertices along its
// seams. `distance`: in the unit of the file, not negative.
std::vector<std::size_t> welded(const std::vector<Eigen::Vector3d>& vertices, double distance);

// Welds the mesh by such a list. The other vertices keep their order.
void weld(const std::vector<std::size_t>& to, Mesh& mesh);

}  // namespace qddot::mesh
