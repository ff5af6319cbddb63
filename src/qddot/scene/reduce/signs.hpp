#pragma once

#include <Eigen/Core>

namespace qddot::reduce {

// A matrix diag(+-1, +-1, +-1), as a bit for each coordinate whose sign changes.
struct Signs {
  unsigned char minus = 0;

  Eigen::Vector3d diagonal() const {
    const auto sign = [&](int d) { return minus >> d & 1 ? -1. : 1.; };
    return {sign(0), sign(1), sign(2)};
  }
  // The product of two.
  Signs times(Signs other) const { return {static_cast<unsigned char>(minus ^ other.minus)}; }
  // The same with the sign + for the coordinates whose bits are set.
  Signs without(unsigned coordinates) const {
    return {static_cast<unsigned char>(minus & ~coordinates)};
  }
  bool are_all_plus() const { return minus == 0; }
};

}  // namespace qddot::reduce
