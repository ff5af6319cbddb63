#pragma once

#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// As many unknowns as a node has.
inline constexpr int most_block_unknowns = 3;

// Where the blocks of a symmetric pattern begin, and last its size: runs of at most three unknowns
// with the same neighbours, themselves among them, as those of a node are. Entries between two
// blocks are all there or all absent.
std::vector<int> block_starts(const SymmetricMatrix& pattern);

}  // namespace qddot
