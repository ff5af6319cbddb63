#pragma once

#include <array>
#include <optional>

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

// The first s in [0, 1] at which the polynomial is below `bound`, to a millionth; nothing if there
// is none.
std::optional<double> first_below(const SquaredLength& c, double bound);

}  // namespace qddot
