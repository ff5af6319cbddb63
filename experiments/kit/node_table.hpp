#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline kit {

// Appends the columns of a table of nodes in 1, 2 or 3 dimensions to `header`: node,x,y,z,vx,vy,vz
// (node,x,vx in 1D).
inline std::vector<std::string> node_header(int dimension, std::vector<std::string> header) {
  constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  header.emplace_back("node");
  for (int d = 0; d < dimension; ++d) header.emplace_back(axes[d]);
  for (int d = 0; d < dimension; ++d) header.emplace_back(fmt::format("v{}", axes[d]));
  return header;
}

// Writes a row for each node: the time [s] if the table has it, index, position [m] and velocity
// [m/s].
inline void write_nodes(Csv& csv, const std::vector<Node>& nodes, int dimension,
                        std::optional<double> t = {}) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (t) csv.field(*t);
    csv.field(i);
    for (int d = 0; d < dimension; ++d) csv.field(nodes[i].position[d]);
    for (int d = 0; d < dimension; ++d) csv.field(nodes[i].velocity[d]);
    csv.end_row();
  }
}

}  // namespace qddot::inline kit
