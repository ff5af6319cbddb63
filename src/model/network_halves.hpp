#pragma once

#include <vector>

#include "qddot/model/mass_spring.hpp"

namespace qddot {

// The network with its stiff springs alone, or with all but these: the halves of a Split.
Network only(Network network, bool stiff);

// The nodes that springs of the network pull at, ascending.
std::vector<int> pulled_nodes(const Network& network);

// The network of these nodes alone, to which all of its springs must belong; it has no loads.
Network among(const std::vector<int>& nodes, const Network& network);

}  // namespace qddot
