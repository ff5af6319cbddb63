#pragma once

#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// A row of a method's table as a vector of weights.
inline Eigen::Map<const Vec> as_vec(const std::vector<double>& row) {
  return {row.data(), static_cast<Index>(row.size())};
}

}  // namespace qddot
