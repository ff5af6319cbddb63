#pragma once

#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// The numbers of nodes that springs join, directly or through each other, and of these springs.
// Pinned nodes pass no motion on, so they join nothing and belong to no part.
struct PartMembers {
  std::vector<int> nodes;    // not pinned, ascending
  std::vector<int> springs;  // with an end among them, ascending
};

// The parts of a scene in the order of their first nodes; by union-find, in nearly linear time.
std::vector<PartMembers> parts_of(const std::vector<Node>& nodes,
                                  const std::vector<Spring>& springs);

// The same nodes and springs as one part; no part if there is none.
std::vector<PartMembers> joined(std::vector<PartMembers> parts);

}  // namespace qddot::reduce
