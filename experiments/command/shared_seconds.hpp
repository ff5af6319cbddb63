#pragma once

#include <algorithm>

namespace qddot::command {

// The most wall time [s] that work of `sum` seconds takes which so many threads share piece by
// piece, whatever the order of its pieces, the longest of which takes `longest`: until the last one
// begins no thread is idle (Graham, Bell System Technical Journal 45, 1966).
inline double shared_seconds_at_most(double sum, double longest, int threads) {
  return std::max(0.0, sum - longest) / threads + longest;
}

}  // namespace qddot::command
