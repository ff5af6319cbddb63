#pragma once

#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// The most unknowns of a block: those of a node.
inline constexpr int most_block_unknowns = 3;

// The first unknown of each block of a symmetric n x n pattern, and last n. A block is a run of at
// most three unknowns with the same neighbours, itself included, such as those of a node. Entries
// between two blocks are all there or all absent.
std::vector<int> block_starts(const SymmetricMatrix& pattern);

}  // namespace qddot
