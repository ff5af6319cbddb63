#pragma once

#include <vector>

#include "qddot/model/mass_spring.hpp"

namespace qddot {

// The network with only its stiff springs (`stiff`), or with all others: the halves of a Split.
Network only(Network network, bool stiff);

// The nodes that have a spring, ascending.
std::vector<int> pulled_nodes(const Network& network);

// The network of these nodes alone. All springs of `network` must join them, and it must have no
// loads.
Network among(const std::vector<int>& nodes, const Network& network);

}  // namespace qddot
