#pragma once

#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// Nodes that springs join, directly or through each other. Pinned nodes join nothing: they pass no
// motion on.
struct Component {
  std::vector<std::size_t> nodes;    // not pinned, ascending
  std::vector<std::size_t> springs;  // with an end among them, ascending
};

// The components of all nodes that are not pinned, in the order of their first nodes; by
// union-find, in nearly linear time.
std::vector<Component> components_of(const std::vector<Node>& nodes,
                                     const std::vector<Spring>& springs);

// The same nodes and springs as one component; none of none.
std::vector<Component> joined(const std::vector<Component>& components);

}  // namespace qddot::reduce
