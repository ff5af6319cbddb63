#include "qddot/analysis/linear_motion.hpp"

#include <cmath>
#include <stdexcept>

#include "qddot/algebra/dense_pairs.hpp"

namespace qddot {
namespace {

// sin(x)/x, continuous at x = 0.
double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

}  // namespace

LinearMotion::LinearMotion(const System& system)
    : system_(system), root_mass_(system.mass().cwiseSqrt()) {
  if (!system.has_stiffness() || !system.stiffness_is_constant() || system.has_massless()) {
    throw std::invalid_argument("the exact motion needs a constant K and positive masses");
  }
  if (system.size() == 0) return;
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(Vec::Zero(system.size()), k);
  const Vec per_root = root_mass_.cwiseInverse();
  const SymmetricMatrix a = -(per_root.asDiagonal() * k * per_root.asDiagonal());
  const EigenPairs modes = dense_pairs(Eigen::MatrixXd(a));
  u_ = modes.vectors;
  omega_ = modes.values.cwiseMax(0).cwiseSqrt();  // w^2 is negative by rounding only
}

State LinearMotion::after(const State& from, double duration) const {
  State to;
  Scratch scratch;
  propagate(from, duration, to, scratch);
  return to;
}

void LinearMotion::propagate(const State& from, double duration, State& to,
                             Scratch& scratch) const {
  auto& [f, velocity, push, y, rate] = scratch;
  const double t = duration;
  f.resize(from.q.size());
  y.resize(omega_.size());
  rate.resize(omega_.size());
  system_.force(from.q, f);
  y = root_mass_.cwiseProduct(from.v);
  velocity.noalias() = u_.transpose() * y;  // y'(0)
  f = f.cwiseQuotient(root_mass_);
  push.noalias() = u_.transpose() * f;  // U'b
  for (Index j = 0; j < omega_.size(); ++j) {
    const double wt = omega_[j] * t, half = sinc(wt / 2);
    y[j] = velocity[j] * t * sinc(wt) + push[j] * 0.5 * t * t * half * half;
    rate[j] = velocity[j] * std::cos(wt) + push[j] * t * sinc(wt);
  }
  to.t = from.t + t;
  to.q.noalias() = u_ * y;
  to.q = from.q + to.q.cwiseQuotient(root_mass_);
  to.v.noalias() = u_ * rate;
  to.v = to.v.cwiseQuotient(root_mass_);
}

}  // namespace qddot
