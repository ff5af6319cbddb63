#include "qddot/scene/reduce/as_drawn.hpp"

#include "qddot/scene/reduce/drawn_part.hpp"

namespace qddot::reduce {
namespace {

constexpr double eps = 0x1p-52;
// The error of a product below the smallest normal number is at most this; a term of a sum has some
// products.
constexpr double underflow = 8 * 0x1p-1074;

}  // namespace

Tolerances tolerances_of(double farthest, double fastest) {
  constexpr double several = 8;
  return {several * rounding * farthest, several * rounding * fastest};
}

void DrawnPotential::add(const SpringLaw& law, double l) {
  const double off = 4 * (place_ + eps * (l + law.rest_length));
  const double strained = std::abs(l - law.rest_length) + off;
  const double energy = law.energy(l);
  sum_.value += energy;
  sum_.error +=
      (std::abs(law.tension(l)) + 0.5 * law.tangent(law.rest_length + strained) * off) * off +
      underflow * (1 + strained * strained);
  sizes_ += energy;
  ++terms_;
}

void DrawnPotential::add(double mass, const Eigen::Vector3d& x, const Eigen::Vector3d& load) {
  const double pull = mass * weight_ + load.norm();
  sum_.value -= mass * gravity_.dot(x) + load.dot(x);
  sum_.error += pull * place_ + underflow * (1 + weight_ + load.norm()) * (1 + farthest_);
  sizes_ += 4 * pull * farthest_;
  ++terms_;
}

BoundedEnergy DrawnPotential::sum() const {
  BoundedEnergy sum = sum_;
  sum.error += (rounding + static_cast<double>(terms_) * eps) * sizes_;
  return sum;
}

void DrawnKinetic::add(double mass, const Eigen::Vector3d& v) {
  sum_.value += 0.5 * mass * v.squaredNorm();
  sum_.error += mass * (v.norm() + 0.5 * off_) * off_ + underflow * (1 + v.squaredNorm());
  ++terms_;
}

BoundedEnergy DrawnKinetic::sum() const {
  BoundedEnergy sum = sum_;
  sum.error += (rounding + static_cast<double>(terms_) * eps) * sum.value;
  return sum;
}

}  // namespace qddot::reduce
