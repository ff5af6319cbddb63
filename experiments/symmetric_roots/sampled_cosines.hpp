#pragma once

#include <vector>

namespace qddot::spurious_roots {

// Set number `index` of `pairs` cosines, from -1 to 0.95, descending. The sets are points of
// Halton's sequence (Numerische Mathematik 2 (1960) 84-90), which fills that space evenly and is
// the same each time. index from 1; pairs from 1 to 5.
std::vector<double> sampled_cosines(int index, int pairs);

}  // namespace qddot::spurious_roots
