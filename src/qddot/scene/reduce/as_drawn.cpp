#include "qddot/scene/reduce/as_drawn.hpp"

#include "qddot/scene/reduce/drawn_part.hpp"

namespace qddot::reduce {
namespace {

constexpr double eps = 0x1p-52;
// The error of a product below the smallest normal number is at most this; a term of a sum has some
// products.
constexpr double underflow = 8 * 0x1p-1074;

}  // namespace

Tolerances tolerances_of(const std::vector<Eigen::Vector3d>& x,
                         const std::vector<Eigen::Vector3d>& v) {
  constexpr double several = 8;
  return {several * rounding * largest_coordinate(x), several * rounding * largest_coordinate(v)};
}

BoundedEnergy potential_of(std::span<const Spring> springs, const std::vector<Eigen::Vector3d>& x,
                           const std::vector<double>& mass, const Eigen::Vector3d& gravity,
                           const std::vector<Eigen::Vector3d>& load, const Tolerances& tolerances) {
  BoundedEnergy sum;
  double sizes = 0;
  for (const Spring& spring : springs) {
    const SpringLaw& law = spring.law;
    const double l = (x[spring.nodes[1]] - x[spring.nodes[0]]).norm();
    const double off = 4 * (tolerances.place + eps * (l + law.rest_length));
    const double strained = std::abs(l - law.rest_length) + off;
    const double energy = law.energy(l);
    sum.value += energy;
    sum.error +=
        (std::abs(law.tension(l)) + 0.5 * law.tangent(law.rest_length + strained) * off) * off +
        underflow * (1 + strained * strained);
    sizes += energy;
  }
  const double farthest = largest_coordinate(x), weight = gravity.norm();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double pull = mass[i] * weight + load[i].norm();
    sum.value -= mass[i] * gravity.dot(x[i]) + load[i].dot(x[i]);
    sum.error +=
        pull * tolerances.place + underflow * (1 + weight + load[i].norm()) * (1 + farthest);
    sizes += 4 * pull * farthest;
  }
  sum.error += (rounding + static_cast<double>(springs.size() + x.size()) * eps) * sizes;
  return sum;
}

BoundedEnergy kinetic_of(const std::vector<Eigen::Vector3d>& v, const std::vector<double>& mass,
                         const Tolerances& tolerances) {
  BoundedEnergy sum;
  const double off = tolerances.speed;
  for (std::size_t i = 0; i < v.size(); ++i) {
    sum.value += 0.5 * mass[i] * v[i].squaredNorm();
    sum.error += mass[i] * (v[i].norm() + 0.5 * off) * off + underflow * (1 + v[i].squaredNorm());
  }
  sum.error += (rounding + static_cast<double>(v.size()) * eps) * sum.value;
  return sum;
}

}  // namespace qddot::reduce
