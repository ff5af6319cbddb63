#include "src/analysis/linear_motion.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>

namespace qddot {
namespace {

// sin(x)/x, whole at x = 0.
double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

}  // namespace

LinearMotion::LinearMotion(const System& system, const State& initial)
    : initial_(initial), root_mass_(system.mass().cwiseSqrt()) {
  if (!system.stiffness_is_constant() || system.has_massless()) {
    throw std::invalid_argument("the exact motion needs a constant K and positive masses");
  }
  if (system.size() == 0) return;
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(initial.q, k);
  Vec f(system.size());
  system.force(initial.q, f);
  const Vec per_root = root_mass_.cwiseInverse();
  const SymmetricMatrix a = -(per_root.asDiagonal() * k * per_root.asDiagonal());
  // The solver reads the lower triangle only.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes{Eigen::MatrixXd(a)};
  u_ = modes.eigenvectors();
  omega_ = modes.eigenvalues().cwiseMax(0).cwiseSqrt();  // rounding alone makes w^2 negative
  velocity_ = u_.transpose() * root_mass_.cwiseProduct(initial.v);
  push_ = u_.transpose() * per_root.cwiseProduct(f);
}

State LinearMotion::at(double time) const {
  const double t = time - initial_.t;
  if (omega_.size() == 0) return {time, initial_.q, initial_.v};
  Vec y(omega_.size()), rate(omega_.size());
  for (Index j = 0; j < omega_.size(); ++j) {
    const double wt = omega_[j] * t, half = sinc(wt / 2);
    y[j] = velocity_[j] * t * sinc(wt) + push_[j] * 0.5 * t * t * half * half;
    rate[j] = velocity_[j] * std::cos(wt) + push_[j] * t * sinc(wt);
  }
  return {time, initial_.q + (u_ * y).cwiseQuotient(root_mass_),
          (u_ * rate).cwiseQuotient(root_mass_)};
}

}  // namespace qddot
