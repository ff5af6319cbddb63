#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::motion_files {

// What joins the nodes in a picture: a point for each node on no spring and no face, a line for
// each spring, a triangle for each face; cells are counted in that order.
struct Cells {
  std::vector<std::size_t> points;
  std::vector<std::array<std::size_t, 2>> lines;
  std::vector<std::array<std::size_t, 3>> triangles;

  std::size_t count() const { return points.size() + lines.size() + triangles.size(); }
};

Cells cells_of(const Scene& scene);

// The lengths [m] by which strains of the scene's springs are taken, (l - length) / length: the
// rest length; where that is zero, the length between the nodes as the motion starts, `nodes`. Zero
// where both are.
std::vector<double> strain_lengths(const Scene& scene, const std::vector<Node>& nodes);

}  // namespace qddot::motion_files
