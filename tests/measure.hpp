#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include <Eigen/Dense>

#include "qddot/model/capabilities.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
inline namespace tests {

inline constexpr double eps = machine_epsilon;

// The slope of the line through the points (x_i, y_i) by least squares.
inline double slope(const Vec& x, const Vec& y) {
  const Vec centred = x.array() - x.mean();
  return centred.dot(y) / centred.squaredNorm();
}

// The order p of errors ~ C h^p at h, h/2, h/4, ...: the slope of log2(error) over log2(h) for all
// of them, so that no single pair decides.
inline double observed_order(std::span<const double> errors) {
  const auto count = static_cast<Index>(errors.size());
  const Vec halvings = Vec::LinSpaced(count, 0, static_cast<double>(count - 1));
  const Vec logarithms = Eigen::Map<const Vec>(errors.data(), count).array().log() / std::log(2.0);
  return -slope(halvings, logarithms);
}

// The Jacobian dg/dq of g: Vec -> Vec, column by column, from central differences of fourth order
//   g' = (8 (g(q+h) - g(q-h)) - (g(q+2h) - g(q-2h))) / 12 h.
// A gradient is the one row of a g that gives a Vec of length 1. An entry is wrong by
// h^4 |g^(5)| / 30 from truncation and about eps |g| / h from rounding.
template <class Function>
Eigen::MatrixXd finite_difference_jacobian(const Function& g, const Vec& q, double h) {
  const auto beside = [&](Index j, double distance) -> Vec {
    Vec moved = q;
    moved[j] += distance;
    return g(moved);
  };
  Eigen::MatrixXd jacobian(g(q).size(), q.size());
  for (Index j = 0; j < q.size(); ++j) {
    jacobian.col(j) =
        (8 * (beside(j, h) - beside(j, -h)) - (beside(j, 2 * h) - beside(j, -2 * h))) / (12 * h);
  }
  return jacobian;
}

// The symmetric matrix whose lower triangle is `lower`.
inline Eigen::MatrixXd dense(const SymmetricMatrix& lower) {
  return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
}

// Whether two matrices have entries at the same places, stored alike.
inline bool same_pattern(const SymmetricMatrix& a, const SymmetricMatrix& b) {
  return a.nonZeros() == b.nonZeros() && a.isCompressed() && b.isCompressed() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

// A capability that a test needs; throws where the system does not offer it.
template <class C>
const C& offered(const System& system) {
  const C* found = capability<C>(system);
  if (!found) throw std::invalid_argument("the system does not offer what the test needs");
  return *found;
}

// Whether nothing says that the system is not valid at q, and whether f is linear there.
inline bool is_valid_at(const System& system, const Vec& q) {
  const auto* validity = capability<Validity>(system);
  return !validity || validity->is_valid_at(q);
}
inline bool is_linear_at(const System& system, const Vec& q) {
  const auto* pieces = capability<PiecewiseLinear>(system);
  return pieces ? pieces->is_linear_at(q) : system.stiffness_is_constant();
}

// f(q), K(q), its material part and the discrete gradient by value.
inline Vec force_at(const System& system, const Vec& q) {
  Vec f(system.size());
  system.force(q, f);
  return f;
}
inline SymmetricMatrix stiffness_at(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  return k;
}
inline SymmetricMatrix material_stiffness_at(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  offered<SplitStiffness>(system).material_stiffness(q, k);
  return k;
}

inline Vec mean_force_between(const System& system, const Vec& a, const Vec& b) {
  Vec f(system.size());
  offered<DiscreteGradient>(system).discrete_gradient(a, b, f);
  return f;
}

// The least and the largest eigenvalue of a symmetric matrix; 0 if it is empty.
inline double smallest_eigenvalue(const Eigen::MatrixXd& a) {
  return a.rows() == 0 ? 0 : a.selfadjointView<Eigen::Lower>().eigenvalues()[0];
}
inline double largest_eigenvalue(const Eigen::MatrixXd& a) { return -smallest_eigenvalue(-a); }

// All w^2 of -K x = w^2 M x, ascending, by a dense decomposition; masses must be positive.
inline Vec squared_frequencies(const System& system, const Vec& q) {
  const Vec root = system.mass().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd k = root.asDiagonal() * dense(stiffness_at(system, q)) * root.asDiagonal();
  return (-k).selfadjointView<Eigen::Lower>().eigenvalues();
}

// The largest absolute difference of two vectors or matrices of the same size; 0 if they are empty.
// Infinite if a difference is NaN, so that no comparison passes.
template <class A, class B>
double distance(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  if (a.size() == 0) return 0;
  const double largest = (a - b).template lpNorm<Eigen::Infinity>();
  return (a - b).allFinite() ? largest : INFINITY;
}

}  // namespace tests
}  // namespace qddot
