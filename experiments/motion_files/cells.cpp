#include "experiments/motion_files/cells.hpp"

namespace qddot::motion_files {

Cells cells_of(const Scene& scene) {
  Cells cells;
  std::vector<bool> is_joined(scene.nodes.size(), false);
  for (const Spring& spring : scene.springs) {
    cells.lines.push_back(spring.nodes);
    for (const std::size_t node : spring.nodes) is_joined[node] = true;
  }
  cells.triangles = scene.faces;
  for (const auto& face : scene.faces) {
    for (const std::size_t node : face) is_joined[node] = true;
  }
  for (std::size_t i = 0; i < is_joined.size(); ++i) {
    if (!is_joined[i]) cells.points.push_back(i);
  }
  return cells;
}

std::vector<double> strain_lengths(const Scene& scene, const std::vector<Node>& nodes) {
  std::vector<double> lengths;
  lengths.reserve(scene.springs.size());
  for (const auto& [ends, law, holds, stiff] : scene.springs) {
    const auto& from = nodes[ends[0]].position;
    const auto& to = nodes[ends[1]].position;
    lengths.push_back(law.rest_length > 0 ? law.rest_length : (to - from).norm());
  }
  return lengths;
}

}  // namespace qddot::motion_files
