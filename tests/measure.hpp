#pragma once

#include <functional>
#include <span>
#include <stdexcept>

#include <Eigen/Dense>

#include "qddot/model/capabilities.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
inline namespace tests {

inline constexpr double eps = machine_epsilon;

// The slope of the line through the points (x_i, y_i) by least squares.
double slope(const Vec& x, const Vec& y);

// The order p of errors ~ C h^p at h, h/2, h/4, ...: the slope of log2(error) over log2(h) for all
// of them, so that no single pair decides.
double observed_order(std::span<const double> errors);

// The Jacobian dg/dq of g: Vec -> Vec, column by column, from central differences of fourth order
//   g' = (8 (g(q+h) - g(q-h)) - (g(q+2h) - g(q-2h))) / 12 h.
// A gradient is the one row of a g that gives a Vec of length 1. An entry is wrong by
// h^4 |g^(5)| / 30 from truncation and about eps |g| / h from rounding.
Eigen::MatrixXd finite_difference_jacobian(const std::function<Vec(const Vec&)>& g, const Vec& q,
                                           double h);

// The symmetric matrix whose lower triangle is `lower`.
Eigen::MatrixXd dense(const SymmetricMatrix& lower);

// Whether two matrices have entries at the same places, stored alike.
bool same_pattern(const SymmetricMatrix& a, const SymmetricMatrix& b);

// A capability that a test needs; throws if the system lacks it.
template <class C>
const C& offered(const C* found) {
  if (!found) throw std::invalid_argument("the system does not offer what the test needs");
  return *found;
}

// Whether nothing says that the system is not valid at q, and whether f is linear there.
bool is_valid_at(const System& system, const Vec& q);
bool is_linear_at(const System& system, const Vec& q);

// f(q), K(q), its material part and the discrete gradient by value.
Vec force_at(const System& system, const Vec& q);
SymmetricMatrix stiffness_at(const System& system, const Vec& q);
SymmetricMatrix material_stiffness_at(const System& system, const Vec& q);
Vec mean_force_between(const System& system, const Vec& a, const Vec& b);

// The eigenvalues of the symmetric matrix with this lower triangle, ascending.
Vec eigenvalues(const Eigen::MatrixXd& lower);
// x of a x = b, by a dense decomposition.
Vec solution(const Eigen::MatrixXd& a, const Vec& b);
// The least and the largest eigenvalue of a symmetric matrix; 0 if it is empty.
double smallest_eigenvalue(const Eigen::MatrixXd& a);
double largest_eigenvalue(const Eigen::MatrixXd& a);

// All w^2 of -K x = w^2 M x, ascending, by a dense decomposition; masses must be positive.
Vec squared_frequencies(const System& system, const Vec& q);

// The largest absolute difference of two vectors or matrices of the same size; 0 if they are empty.
// Infinite if a difference is NaN, so that no comparison passes.
double distance(const Eigen::Ref<const Eigen::MatrixXd>& a,
                const Eigen::Ref<const Eigen::MatrixXd>& b);

}  // namespace tests
}  // namespace qddot
