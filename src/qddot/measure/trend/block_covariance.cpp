#include "qddot/measure/trend/block_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace qddot::inline measure {
namespace {

// Below this rate the series is used: rounding of the closed form exceeds the terms that it leaves
// out.
constexpr double small_rate = 1e-3;

}  // namespace

Eigen::MatrixXd walk_covariance(Index n) {
  return Eigen::MatrixXd::NullaryExpr(n, n, [](Index i, Index j) {
    const auto first = static_cast<double>(std::min(i, j) + 1);
    return i == j ? first - 2.0 / 3 : first - 0.5;
  });
}

Eigen::MatrixXd oscillation_covariance(Index n, std::complex<double> rate) {
  const std::complex<double> left = std::exp(-rate);
  const bool is_small = std::abs(rate) < small_rate;
  const std::complex<double> mean = is_small ? 1.0 - rate / 2.0 : (1.0 - left) / rate;
  const std::complex<double> own =
      is_small ? 1.0 - rate / 3.0 : 2.0 * (rate - 1.0 + left) / (rate * rate);
  std::vector<double> at(static_cast<std::size_t>(n), own.real());  // by distance in blocks
  std::complex<double> covariance = mean * mean;
  for (std::size_t distance = 1; distance < at.size(); ++distance) {
    at[distance] = covariance.real();
    covariance *= left;
  }
  return Eigen::MatrixXd::NullaryExpr(
      n, n, [&](Index i, Index j) { return at[static_cast<std::size_t>(std::abs(i - j))]; });
}

}  // namespace qddot::inline measure
