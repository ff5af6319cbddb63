#pragma once

#include <span>
#include <string_view>

#include "qddot/model/kernels/neighbour_slices.hpp"

namespace qddot::kernels {

// Names the roots in use: those that the environment's QDDOT_ROOTS names or, without, the
// processor's own unless others are clearly faster here, timed for about a millisecond when this is
// first called. Throws NoSuchKernels where this processor has none of that name.
Roots roots();

// Lists the names of all kinds, in the order of Roots.
std::span<const std::string_view> names_of_roots();

// Whether all springs are so that no number on the way from an estimate to their tension is too
// large or too small; of lengths the kernels see to that.
bool can_be_estimated(const NeighbourSlices& slices);

}  // namespace qddot::kernels
