#include "experiments/symmetric_roots/recurrence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/integrators/base/symmetric_formula.hpp"

namespace qddot::spurious_roots {
namespace {

using Powers = std::vector<double>;  // of y, the lowest first

// p(z)/z^d of a palindrome of degree 2 d, in powers of y = (z + 1/z)/2. It is p_d + sum 2 p_{d+i}
// T_i(y), with Chebyshev's T_{i+2} = 2 y T_{i+1} - T_i.
Powers powers_of_cosine(const std::vector<double>& palindrome) {
  const std::size_t degree = palindrome.size() / 2;
  Powers sum(degree + 1), now(degree + 1), next(degree + 1);  // T_i and T_{i+1}
  now[0] = next[1] = 1;
  for (std::size_t i = 0; i <= degree; ++i) {
    const double weight = (i == 0 ? 1 : 2) * palindrome[degree + i];
    for (std::size_t p = 0; p <= degree; ++p) sum[p] += weight * now[p];
    Powers after(degree + 1);
    for (std::size_t p = 0; p < degree; ++p) after[p + 1] = 2 * next[p];
    for (std::size_t p = 0; p <= degree; ++p) after[p] -= now[p];
    now = next;
    next = after;
  }
  return sum;
}

double value(const Powers& p, double y) {
  double sum = 0;
  for (std::size_t i = p.size(); i-- > 0;) sum = sum * y + p[i];
  return sum;
}

// The real y at which a/b has no slope: a' b - a b' = 0.
std::vector<double> critical_points(const Powers& a, const Powers& b) {
  Powers slope(a.size() + b.size() - 2);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (i + j > 0) {
        slope[i + j - 1] += (static_cast<double>(i) - static_cast<double>(j)) * a[i] * b[j];
      }
    }
  }
  const Eigen::Index degree = std::ssize(slope) - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  for (Eigen::Index i = 0; i < degree; ++i) {
    companion(i, degree - 1) = -slope[static_cast<std::size_t>(i)] / slope.back();
    if (i > 0) companion(i, i - 1) = 1;
  }
  std::vector<double> points;
  for (const std::complex<double> y : general_values(companion)) {
    if (y.imag() == 0) points.push_back(y.real());
  }
  return points;
}

}  // namespace

// h^2 w^2 = -rho/beta is a function of the cosine y. All roots begin on the unit circle, each with
// a real y from -1 to 1. A root leaves the circle when it meets another, where the function has
// zero slope, or at y = -1.
double stability_limit(const Coefficients& formula) {
  const Powers rho = powers_of_cosine(formula.rho), beta = powers_of_cosine(formula.beta);
  std::vector<double> points = critical_points(rho, beta);
  points.push_back(-1);
  double least = std::numeric_limits<double>::infinity();
  for (const double y : points) {
    const double square = -value(rho, y) / value(beta, y);
    if (y >= -1 && y < 1 && square > 0) least = std::min(least, square);
  }
  return std::sqrt(least);
}

std::vector<double> root_angles(const Coefficients& formula, double h_omega) {
  std::vector<double> sum = formula.rho;
  for (std::size_t j = 0; j < formula.beta.size(); ++j) {
    sum[j + 1] += h_omega * h_omega * formula.beta[j];
  }
  std::vector<double> angles;
  for (const std::complex<double> y : cosines_of_roots(sum)) {
    angles.push_back(std::acos(std::clamp(y.real(), -1.0, 1.0)));
  }
  std::ranges::sort(angles);
  return angles;
}

double phase_error(const Coefficients& formula, double h_omega) {
  double least = std::numeric_limits<double>::infinity();
  for (const double angle : root_angles(formula, h_omega)) {
    least = std::min(least, std::abs(angle - h_omega) / h_omega);
  }
  return least;
}

double root_gap(const Coefficients& formula, const std::vector<double>& h_omegas) {
  double least = std::numeric_limits<double>::infinity();
  for (const double h_omega : h_omegas) {
    const std::vector<double> angles = root_angles(formula, h_omega);
    least = std::min(least, 2 * (M_PI - angles.back()));  // to its conjugate
    for (std::size_t i = 1; i < angles.size(); ++i) {
      least = std::min(least, angles[i] - angles[i - 1]);
    }
  }
  return least;
}

}  // namespace qddot::spurious_roots
