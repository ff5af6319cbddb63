#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::motion_files {

// The cells of a picture, numbered in this order: a point for each node on no spring and no face, a
// line for each spring, a triangle for each face.
struct Cells {
  std::vector<std::size_t> points;
  std::vector<std::array<std::size_t, 2>> lines;
  std::vector<std::array<std::size_t, 3>> triangles;

  std::size_t count() const { return points.size() + lines.size() + triangles.size(); }
};

Cells cells_of(const Scene& scene);

// The lengths [m] of the scene's springs that define their strains, (l - length) / length. A length
// is the rest length or, if that is zero, the distance of the nodes at the start of the motion,
// `nodes`; zero if both are.
std::vector<double> strain_lengths(const Scene& scene, const std::vector<Node>& nodes);

}  // namespace qddot::motion_files
