#include "experiments/local_level.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace qddot {
namespace {

// Ratios of the variances of walk and noise, from none to a walk alone.
constexpr double least_ratio = 1e-4, most_ratio = 1e4, ratio_step = 2;

struct Fit {
  double ratio, slope, slope_variance, level, variance, log_likelihood;
};

// Generalised least squares of y on a + b (j - middle) with the covariance s^2 (I + ratio W),
// W_ij = min(i, j), and its restricted likelihood (Harville, J. American Statistical Association 72
// (1977) 320-338). `least`: what the sum of squares is at least, since y is rounded.
Fit fit(const Vec& y, double ratio, double least) {
  const Index n = y.size();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd x(n, 3);  // a and b, and y beside them
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) covariance(i, j) += ratio * static_cast<double>(std::min(i, j));
    x.row(i) << 1, static_cast<double>(i) - static_cast<double>(n - 1) / 2, y[i];
  }
  const Eigen::LLT<Eigen::MatrixXd> factors(covariance);
  factors.matrixL().solveInPlace(x);
  const Eigen::Matrix2d normal = x.leftCols<2>().transpose() * x.leftCols<2>();
  const Eigen::Vector2d line = normal.inverse() * (x.leftCols<2>().transpose() * x.col(2));
  const double freedom = static_cast<double>(n - 2);
  const double squares = std::max(least, (x.col(2) - x.leftCols<2>() * line).squaredNorm());
  const double variance = squares / freedom;
  const double log_determinant = 2 * factors.matrixLLT().diagonal().array().log().sum();
  return {ratio,
          line[1],
          variance * normal.inverse()(1, 1),
          line[0],
          variance,
          -0.5 * (log_determinant + std::log(normal.determinant()) + freedom * std::log(squares))};
}

}  // namespace

LocalLevel fit_local_level(const Vec& y) {
  assert(y.size() >= 4);
  const double rounding = std::numeric_limits<double>::epsilon() * y.lpNorm<Eigen::Infinity>();
  const double least = std::max(static_cast<double>(y.size()) * rounding * rounding,
                                std::numeric_limits<double>::min());
  std::vector<Fit> fits = {fit(y, 0, least)};
  for (double ratio = least_ratio; ratio <= most_ratio; ratio *= ratio_step) {
    fits.push_back(fit(y, ratio, least));
  }
  const Fit& best = *std::ranges::max_element(fits, {}, &Fit::log_likelihood);

  double sum = 0, mean = 0, square = 0;
  for (const Fit& f : fits) {
    const double weight = std::exp(f.log_likelihood - best.log_likelihood);
    sum += weight;
    mean += weight * f.slope;
    square += weight * (f.slope_variance + (f.slope - best.slope) * (f.slope - best.slope));
  }
  mean /= sum;
  const double deviation =
      std::sqrt(std::max(square / sum - (mean - best.slope) * (mean - best.slope), 0.0));
  // The 97.5 % quantile of Student's t, to 0.1 % from ten degrees of freedom on and to a tenth with
  // two (Abramowitz and Stegun, 26.7.5).
  const double freedom = static_cast<double>(y.size() - 2), z = 1.959964;
  const double quantile = z + (z * z * z + z) / (4 * freedom) +
                          (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * freedom * freedom);
  const double half = quantile * deviation;
  return {{mean, mean - half, mean + half},
          best.level,
          std::sqrt(best.ratio * best.variance),
          std::sqrt(best.variance),
          2 * (best.log_likelihood - fits.front().log_likelihood)};
}

}  // namespace qddot
