#include "qddot/analysis/linear_motion.hpp"

#include <cmath>
#include <stdexcept>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/analysis/damped_mode.hpp"
#include "qddot/model/capabilities.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

// A negative eigenvalue is a rounding error if it is no more than so many roundings of the largest
// one for each unknown.
constexpr double roundings_of_zero = 16;

// sin(x)/x and cos x of a mode that vibrates, and sinh(x)/x and cosh x of one that grows; all are
// continuous at x = 0.
double sinc(bool grows, double x) { return x == 0 ? 1 : (grows ? std::sinh(x) : std::sin(x)) / x; }
double cosine(bool grows, double x) { return grows ? std::cosh(x) : std::cos(x); }

}  // namespace

bool LinearMotion::has_modes(const System& system) {
  const Damping* damping = system.damping();
  const bool is_known =
      system.is_autonomous() || (system.driving() && system.driving()->forcing(0));
  return is_known && (damping ? damping->damping_time().has_value() : system.is_conservative());
}

LinearMotion::LinearMotion(const System& system)
    : system_(system), root_mass_(system.mass().cwiseSqrt()) {
  if (!system.has_stiffness() || !system.stiffness_is_constant() || system.has_massless()) {
    throw std::invalid_argument("the exact motion needs a constant K and positive masses");
  }
  if (!has_modes(system)) {
    throw std::invalid_argument(
        "modes stay apart only if C = alpha M - beta K, and forces of time are sums of harmonics "
        "and piecewise polynomials");
  }
  if (system.size() == 0) return;
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(Vec(Vec::Zero(system.size())), k);
  const Vec per_root = root_mass_.cwiseInverse();
  const SymmetricMatrix a = -(per_root.asDiagonal() * k * per_root.asDiagonal());
  const EigenPairs modes = dense_pairs(Eigen::MatrixXd(a));
  u_ = modes.vectors;
  const double least = roundings_of_zero * machine_epsilon * static_cast<double>(system.size()) *
                       modes.values.lpNorm<Eigen::Infinity>();
  squares_ = (modes.values.array() < 0 && modes.values.array() > -least).select(0, modes.values);
  if (const Damping* damping = system.damping()) {
    gamma_ = ((damping->air_damping() + *damping->damping_time() * squares_.array()) / 2).matrix();
  }
}

double LinearMotion::fastest() const {
  return squares_.size() > 0 ? std::sqrt(squares_.lpNorm<Eigen::Infinity>()) : 0;
}

State LinearMotion::after(const State& from, double duration) const {
  State to;
  Scratch scratch;
  propagate(from, duration, to, scratch);
  return to;
}

void LinearMotion::propagate(const State& from, double duration, State& to,
                             Scratch& scratch) const {
  auto& [f, velocity, push, y, rate, forced] = scratch;
  const double t = duration;
  f.resize(from.q.size());
  y.resize(squares_.size());
  rate.resize(squares_.size());
  if (system_.driving() && system_.damping()) {
    rate.setZero();  // dashpots of supports that move pull nodes at rest
    system_.force({from.t, from.q, rate}, f);
  } else {
    system_.force({from.t, from.q}, f);
  }
  y = root_mass_.cwiseProduct(from.v);
  velocity.noalias() = u_.transpose() * y;  // y'(0)
  f = f.cwiseQuotient(root_mass_);
  push.noalias() = u_.transpose() * f;  // U'b
  for (Index j = 0; j < gamma_.size(); ++j) {
    const auto [c, s, g] = mode_response(gamma_[j], squares_[j], t);
    y[j] = velocity[j] * s + push[j] * g;
    rate[j] = velocity[j] * c + push[j] * s;
  }
  for (Index j = 0; gamma_.size() == 0 && j < squares_.size(); ++j) {
    const bool grows = squares_[j] < 0;
    const double wt = std::sqrt(std::abs(squares_[j])) * t, half = sinc(grows, wt / 2);
    y[j] = velocity[j] * t * sinc(grows, wt) + push[j] * 0.5 * t * t * half * half;
    rate[j] = velocity[j] * cosine(grows, wt) + push[j] * t * sinc(grows, wt);
  }
  if (const Driving* driving = system_.driving()) {
    const Forcing forcing = *driving->forcing(from.t);
    if (!forced || !forced->is_for(forcing, t)) forced.emplace(squares_, gamma_, forcing, t);
    const auto project = [&](const Vec& force) -> Vec {
      return u_.transpose() * force.cwiseQuotient(root_mass_);
    };
    forced->add(forcing, from.t, project, y, rate);
  }
  to.t = from.t + t;
  to.q.noalias() = u_ * y;
  to.q = from.q + to.q.cwiseQuotient(root_mass_);
  to.v.noalias() = u_ * rate;
  to.v = to.v.cwiseQuotient(root_mass_);
}

}  // namespace qddot
