#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace qddot {
inline namespace tests {

// The number that a share of all are no larger than; NaN of none.
inline double quantile(std::vector<double> all, double share) {
  if (all.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(all);
  return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
}

}  // namespace tests
}  // namespace qddot
