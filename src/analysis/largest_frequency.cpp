#include "src/analysis/largest_frequency.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "src/algebra/leading_pairs.hpp"
#include "src/analysis/frequency_bound.hpp"

namespace qddot {
namespace {

// Of w^2, as a residual: there is an eigenvalue as near, mostly far nearer (3e-6 off for a chain of
// 1e5 masses, whose eigenvalues crowd at the end).
constexpr double relative_error = 1e-4;
// Lanczos' basis would be the whole space.
constexpr Index most_dense = 40;

}  // namespace

double largest_frequency(const System& system, const Vec& q) {
  const double bound = frequency_bound(system, q);
  if (bound == 0 || std::isinf(bound)) return bound;
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  // -M^-1/2 K M^-1/2 over the square of the bound: no eigenvalue is above 1. A massless unknown has
  // no stiffness here.
  const Vec scale =
      (system.mass().array() > 0)
          .select(system.mass().cwiseSqrt().cwiseInverse() / bound, Vec::Zero(k.rows()));
  k = -(scale.asDiagonal() * k * scale.asDiagonal());
  if (k.rows() <= most_dense) {
    const Eigen::MatrixXd dense(k);
    const double top = dense.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
    return bound * std::sqrt(std::max(top, 0.0));
  }
  const auto apply = [&](const Vec& x, Vec& y) { y = k.selfadjointView<Eigen::Lower>() * x; };
  return bound * std::sqrt(std::max(leading_value(apply, k.rows(), relative_error), 0.0));
}

}  // namespace qddot
