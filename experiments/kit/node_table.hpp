#pragma once

#include <string>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline kit {

// Appends the columns of a table of nodes in 1, 2 or 3 dimensions to `header`: node,x,y,z,vx,vy,vz
// (node,x,vx in 1D).
std::vector<std::string> node_header(int dimension, std::vector<std::string> header);

// Completes a row of such a table: index, position [m] and velocity [m/s] of a node.
void write_node(Csv& csv, std::size_t index, const Node& node, int dimension);

}  // namespace qddot::inline kit
