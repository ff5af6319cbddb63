#pragma once

#include "qddot/model/kernels/neighbour_slices.hpp"

namespace qddot::kernels {

// The slots of one shift that store tau/l of their springs, for slots of the opposite shift some
// slices later. Such a slot reads the values if it has exactly the same springs from their other
// ends, none of which are rows of the same slice.
struct Rings {
  std::vector<Ring> rings;
  std::vector<RingUse> uses;  // of the slots of one shift
  Index numbers = 0;          // in the memory of all rings
};

Rings rings_of(const NeighbourSlices& slices);

}  // namespace qddot::kernels
