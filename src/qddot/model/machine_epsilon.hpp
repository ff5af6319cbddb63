#pragma once

#include <limits>

namespace qddot {

// The distance from 1 to the next double. The relative error of a sum or product is at most half of
// it.
inline constexpr double machine_epsilon = std::numeric_limits<double>::epsilon();

}  // namespace qddot
