#pragma once

#include "qddot/scene/reduce/drawn_part.hpp"

namespace qddot::reduce {

// Numbers the free nodes of a large part along its springs, if that brings the ends of springs much
// nearer together. Forces read the positions of neighbours: if those lie anywhere in memory, each
// comes from beyond the caches. Breadth-first, as Cuthill and McKee (1969). Call before the part
// has more than its nodes and springs.
void gather_scattered_nodes(DrawnPart& drawn);

}  // namespace qddot::reduce
