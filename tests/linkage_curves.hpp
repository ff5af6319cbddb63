#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <Eigen/Core>

#include "qddot/scene/scene.hpp"

namespace qddot {
inline namespace tests {

// Whether the node is a support that nothing moves but its curve.
inline bool is_support(const qddot::Node& node) { return node.pinned; }

// The value and the first two derivatives of a curve's polynomial and harmonics. Throws
// std::invalid_argument if it has other terms.
inline Eigen::Matrix<long double, 3, 3> curve_and_rates(const TimeCurve& curve, long double t) {
  if (!curve.tables.empty() || !curve.own.empty())
    throw std::invalid_argument("the independent linkage knows polynomials and harmonics only");
  Eigen::Matrix<long double, 3, 3> all = Eigen::Matrix<long double, 3, 3>::Zero();
  for (std::size_t k = 0; k < curve.polynomial.size(); ++k) {
    const auto c = curve.polynomial[k].cast<long double>();
    const auto n = static_cast<long double>(k);
    all.col(0) += c * std::pow(t, n);
    if (k >= 1) all.col(1) += c * n * std::pow(t, n - 1);
    if (k >= 2) all.col(2) += c * n * (n - 1) * std::pow(t, n - 2);
  }
  for (const TimeCurve::Harmonic& one : curve.harmonics) {
    const auto a = one.amplitude.cast<long double>();
    const long double w = one.frequency, angle = w * t + one.phase;
    all.col(0) += a * std::sin(angle);
    all.col(1) += a * (w * std::cos(angle));
    all.col(2) -= a * (w * w * std::sin(angle));
  }
  return all;
}

}  // namespace tests
}  // namespace qddot
