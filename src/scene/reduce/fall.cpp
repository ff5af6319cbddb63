#include "qddot/scene/reduce/fall.hpp"

#include <algorithm>

#include "qddot/scene/reduce/body.hpp"

namespace qddot::reduce {
namespace {

constexpr double few_roundings = 4 * 0x1p-52;

bool has_loose_node(const Body& body) {
  std::vector<bool> is_on_spring(body.nodes.size(), false);
  for (const Spring& spring : body.springs) {
    for (const std::size_t i : spring.nodes) is_on_spring[i] = true;
  }
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    if (body.mass[i] == 0 && !is_on_spring[i]) return true;
  }
  return false;
}

}  // namespace

void let_fall(Body& body) {
  if (body.free < body.nodes.size() || has_loose_node(body)) return;
  // Differences to one of the velocities: where all are the same, their mean is that to the bit.
  double mass = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    mass += body.mass[i];
    sum += body.mass[i] * (body.v[i] - body.v.front());
  }
  if (!(mass > 0)) return;
  const Eigen::Vector3d mean = body.v.front() + sum / mass;
  if (!mean.allFinite()) return;
  body.fall = {mass, mean, body.gravity};
  for (Eigen::Vector3d& v : body.v) v -= mean;
  body.gravity.setZero();
}

bool rests(const Body& body) {
  if (body.fall.mass == 0) return false;
  const double slow = few_roundings * body.fall.velocity.lpNorm<Eigen::Infinity>();
  if (largest_coordinate(body.v) > slow) return false;
  const double near =
      few_roundings * (largest_coordinate(body.x) + body.origin.lpNorm<Eigen::Infinity>());
  return std::ranges::all_of(body.springs, [&](const Spring& spring) {
    const double l = (body.x[spring.nodes[1]] - body.x[spring.nodes[0]]).norm();
    return std::abs(l - spring.law.rest_length) <= near;
  });
}

}  // namespace qddot::reduce
