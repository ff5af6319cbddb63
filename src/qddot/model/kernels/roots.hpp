#pragma once

#include <span>
#include <string_view>

#include "qddot/model/kernels/neighbour_slices.hpp"

namespace qddot::kernels {

// The kind of roots in use. The environment variable QDDOT_ROOTS may name it. Else it is the
// processor's own, unless another is clearly faster, as timed for a tenth of a millisecond at the
// first call. Throws NoSuchKernels if this processor has none of that name.
Roots roots();

// Lists the names of all kinds, in the order of Roots.
std::span<const std::string_view> names_of_roots();

// Whether estimated roots are safe: no spring's law gives numbers that overflow or underflow
// between the estimate and the tension. The kernels check the lengths.
bool can_be_estimated(const NeighbourSlices& slices);

}  // namespace qddot::kernels
