// Let z = exp(i theta) and x = 1 - cos(theta). A factor of rho(z)/z^{k/2} is
//   (z - 1)^2/z = -2 x   or   (z^2 - 2 c z + 1)/z = 2 ((1 - c) - x),
// so that rho(z)/z^{k/2} = -R(x) with R(x) = 2 x prod 2 ((1 - c_i) - x). Symmetric beta make
// beta(z)/z^{k/2} = S(x), a polynomial of degree k/2 - 1. The formula's roots for q'' = -w^2 q obey
// h^2 w^2 = R(x)/S(x); the exact motion has theta = h w. The order is k if R - theta^2 S is of
// order theta^{k+2}, which is that of x^{k/2+1}. So S is the series of R/theta^2 in x up to
// x^{k/2-1}, with
//   theta^2 = arccos(1 - x)^2 = 2 sum_{m>=1} (2 x)^m / (m^2 binomial(2 m, m)).
#include "experiments/symmetric_roots/formula_of_cosines.hpp"

#include <algorithm>
#include <array>
#include <functional>

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

}  // namespace qddot::spurious_roots
