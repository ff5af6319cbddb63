#pragma once

#include <span>
#include <string_view>

#include "qddot/model/kernels/neighbour_slices.hpp"

namespace qddot::kernels {

// The roots in use, which the environment variable QDDOT_ROOTS may name. They are else the
// processor's own, unless others are clearly faster here, timed for a millisecond at the first
// call. Throws NoSuchKernels if this processor has none of that name.
Roots roots();

// Lists the names of all kinds, in the order of Roots.
std::span<const std::string_view> names_of_roots();

// Whether no spring's law makes a number between an estimate and its tension too large or too
// small. The kernels check the lengths.
bool can_be_estimated(const NeighbourSlices& slices);

}  // namespace qddot::kernels
