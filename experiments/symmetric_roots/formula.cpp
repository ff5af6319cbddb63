// Let z = exp(i theta) and x = 1 - cos(theta). A factor of rho(z)/z^{k/2} is
//   (z - 1)^2/z = -2 x   or   (z^2 - 2 c z + 1)/z = 2 ((1 - c) - x),
// so that rho(z)/z^{k/2} = -R(x) with R(x) = 2 x prod 2 ((1 - c_i) - x). Symmetric beta make
// beta(z)/z^{k/2} = S(x), a polynomial of degree k/2 - 1. The formula's roots for q'' = -w^2 q obey
// h^2 w^2 = R(x)/S(x); the exact motion has theta = h w. The order is k if R - theta^2 S is of
// order theta^{k+2}, which is that of x^{k/2+1}. So S is the series of R/theta^2 in x up to
// x^{k/2-1}, with
//   theta^2 = arccos(1 - x)^2 = 2 sum_{m>=1} (2 x)^m / (m^2 binomial(2 m, m)).
#include "experiments/symmetric_roots/formula.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "qddot/algebra/dense_pairs.hpp"

namespace qddot::spurious_roots {
namespace {

// Powers of x alternate in sign, and their sums lose digits that the results are to have.
using Number = long double;
using Polynomial = std::vector<Number>;  // lowest power first

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial result(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

// theta^2/x in powers of x, so many of them.
Polynomial squared_angle_over_x(std::size_t count) {
  Polynomial series;
  Number term = 2;  // 2 * 2^m / binomial(2 m, m), m = 1
  for (std::size_t i = 0; i < count; ++i) {
    const auto m = static_cast<Number>(i + 1);
    series.push_back(term / (m * m));
    term *= (m + 1) / (2 * m + 1);
  }
  return series;
}

// The first a.size() terms of the series a/b.
Polynomial quotient(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    Number rest = a[i];
    for (std::size_t j = 0; j < i; ++j) rest -= result[j] * b[i - j];
    result.push_back(rest / b[0]);
  }
  return result;
}

// z^d p(1 - (z + 1/z)/2), d the degree of p: a palindrome in powers of z.
std::vector<double> palindrome_of(const Polynomial& p) {
  const std::size_t degree = p.size() - 1;
  Polynomial sum(2 * degree + 1), power = {1};
  for (std::size_t i = 0; i <= degree; ++i) {
    for (std::size_t j = 0; j < power.size(); ++j) sum[degree - i + j] += p[i] * power[j];
    power = product(power, {-0.5L, 1, -0.5L});
  }
  return {sum.begin(), sum.end()};
}

constexpr std::array bases = {2, 3, 5, 7, 11};
// A root with a larger cosine is within 0.3 of the motion's own, and the limit is less than that.
constexpr double lowest = -1, highest = 0.95;

// The digits of the number in a base, mirrored at the point.
double mirrored(int number, int base) {
  double sum = 0, place = 1;
  for (; number > 0; number /= base) {
    place /= base;
    sum += number % base * place;
  }
  return sum;
}

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

Coefficients coefficients_of(const SymmetricFormula& formula) {
  return {formula.all_rho(), formula.all_beta()};
}

Coefficients formula_of_cosines(const std::vector<double>& cosines) {
  Polynomial minus_r_over_x = {-2};
  for (const double c : cosines) {
    minus_r_over_x = product(minus_r_over_x, {2 * (1 - static_cast<Number>(c)), -2});
  }
  Polynomial s = quotient(minus_r_over_x, squared_angle_over_x(minus_r_over_x.size()));
  for (Number& number : s) number = -number;
  return {palindrome_of(product(minus_r_over_x, {0, 1})), palindrome_of(s)};
}

std::vector<double> sampled_cosines(int index, int pairs) {
  std::vector<double> cosines;
  for (int i = 0; i < pairs; ++i) {
    const double share = mirrored(index, bases[static_cast<std::size_t>(i)]);
    cosines.push_back(lowest + (highest - lowest) * share);
  }
  std::ranges::sort(cosines, std::greater());
  return cosines;
}

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
