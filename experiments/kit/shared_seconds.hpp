#pragma once

#include <algorithm>

namespace qddot::inline kit {

// An upper bound of the wall time [s] of work that `threads` threads share piece by piece, in any
// order. `sum` and `longest` [s]: times of all pieces and of the longest one. No thread is idle
// until the last piece begins (Graham, Bell System Technical Journal 45, 1966).
inline double shared_seconds_at_most(double sum, double longest, int threads) {
  return std::max(0.0, sum - longest) / threads + longest;
}

}  // namespace qddot::inline kit
