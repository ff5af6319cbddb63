#pragma once

#include "qddot/model/kernels/neighbour_slices.hpp"

namespace qddot::kernels {

// Which slots of one shift keep their springs' tau/l, and where, for the slots of the opposite
// shift some slices later. Such a slot finds them if it sees exactly the same springs from their
// other ends, none of which are rows of the same slice.
struct Rings {
  std::vector<Ring> rings;
  std::vector<RingUse> uses;  // of the slots of one shift
  Index numbers = 0;          // of the memory that all rings take
};

Rings rings_of(const NeighbourSlices& slices);

}  // namespace qddot::kernels
