#pragma once

#include <limits>

namespace qddot {

// From 1 to the next double; a sum or product errs by at most half of it, relatively.
inline constexpr double machine_epsilon = std::numeric_limits<double>::epsilon();

}  // namespace qddot
