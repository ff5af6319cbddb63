#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace qddot {

// The squared length of a spring [m^2] during a step: a polynomial of degree 6 in s = 0 ... 1, by
// its Bernstein coefficients c. If all c are above a bound, so is the polynomial. c_0 and c_6 are
// its values at the ends.
using SquaredLength = std::array<double, 7>;

// That of the cubic with the Bernstein coefficients a, b, c, d [m].
template <int D>
SquaredLength squared_length(const Eigen::Matrix<double, D, 1>& a,
                             const Eigen::Matrix<double, D, 1>& b,
                             const Eigen::Matrix<double, D, 1>& c,
                             const Eigen::Matrix<double, D, 1>& d) {
  return {a.dot(a),
          a.dot(b),
          (2 * a.dot(c) + 3 * b.dot(b)) / 5,
          (a.dot(d) + 9 * b.dot(c)) / 10,
          (2 * b.dot(d) + 3 * c.dot(c)) / 5,
          c.dot(d),
          d.dot(d)};
}

// The squared length of a quintic with these Bernstein coefficients [m], likewise:
//   c_k = sum over i + j = k of C(5, i) C(5, j) b_i.b_j / C(10, k).
template <int D>
std::array<double, 11> squared_length(const std::array<Eigen::Matrix<double, D, 1>, 6>& b) {
  constexpr std::array of_5 = {1.0, 5.0, 10.0, 10.0, 5.0, 1.0};
  constexpr std::array of_10 = {1.0,   10.0,  45.0, 120.0, 210.0, 252.0,
                                210.0, 120.0, 45.0, 10.0,  1.0};
  std::array<double, 11> c{};
  for (std::size_t i = 0; i < b.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j)
      c[i + j] += of_5[i] * of_5[j] / of_10[i + j] * b[i].dot(b[j]);
  }
  return c;
}

// The first s in [0, 1] at which a polynomial by up to 11 Bernstein coefficients is below `bound`,
// to a millionth; nothing if there is none.
std::optional<double> first_below(std::span<const double> c, double bound);

}  // namespace qddot
