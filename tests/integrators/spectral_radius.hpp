#pragma once

#include <cmath>

#include <Eigen/Core>

namespace qddot {
inline namespace tests {

// The larger modulus of the eigenvalues t +- sqrt(t^2 - d), t half the trace and d the determinant.
inline double spectral_radius(const Eigen::Matrix2d& matrix) {
  const double t = (matrix(0, 0) + matrix(1, 1)) / 2;
  const double d = matrix(0, 0) * matrix(1, 1) - matrix(0, 1) * matrix(1, 0);
  return t * t < d ? std::sqrt(d) : std::abs(t) + std::sqrt(t * t - d);
}

}  // namespace tests
}  // namespace qddot
