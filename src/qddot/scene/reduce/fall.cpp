#include "qddot/scene/reduce/fall.hpp"

#include <algorithm>

#include "qddot/scene/reduce/drawn_part.hpp"

namespace qddot::reduce {
namespace {

constexpr double few_roundings = 4 * 0x1p-52;

bool has_loose_node(const DrawnPart& drawn) {
  if (std::ranges::find(drawn.mass, 0.0) == drawn.mass.end()) return false;
  std::vector<bool> is_on_spring(drawn.nodes.size(), false);
  for (int e = 0; e < drawn.springs.size(); ++e) {
    for (const int i : drawn.springs.ends(e)) is_on_spring[static_cast<std::size_t>(i)] = true;
  }
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    if (drawn.mass[i] == 0 && !is_on_spring[i]) return true;
  }
  return false;
}

}  // namespace

void let_fall(DrawnPart& drawn) {
  if (drawn.free < drawn.nodes.size() || drawn.is_driven() || has_loose_node(drawn)) return;
  // Differences to one of the velocities: if all are equal, so is their mean, to the bit.
  double mass = 0, size_of_loads = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), load = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    mass += drawn.mass[i];
    sum += drawn.mass[i] * (drawn.velocity_of(i) - drawn.velocity_of(0));
    if (!drawn.is_loaded()) continue;
    load += drawn.load[i];
    size_of_loads += drawn.load[i].norm();
  }
  if (!(mass > 0)) return;
  const Eigen::Vector3d mean = drawn.velocity_of(0) + sum / mass;
  if (!mean.allFinite()) return;
  const Eigen::Vector3d mean_load = load / mass;
  if (!mean_load.allFinite()) return;
  drawn.fall = {{mean, drawn.gravity + mean_load, drawn.air_damping}, mass};
  for (Eigen::Vector3d& v : drawn.v) v -= mean;
  drawn.gravity = -mean_load;
  drawn.gravity_noise = rounding * (size_of_loads / mass);
}

bool rests(const DrawnPart& drawn) {
  if (drawn.fall.mass == 0 || drawn.is_loaded()) return false;
  const double slow = few_roundings * drawn.fall.velocity.lpNorm<Eigen::Infinity>();
  if (largest_coordinate(drawn.v) > slow) return false;
  const double near =
      few_roundings * (largest_coordinate(drawn.x) + drawn.origin.lpNorm<Eigen::Infinity>());
  for (int e = 0; e < drawn.springs.size(); ++e) {
    const auto [a, b] = drawn.springs.ends(e);
    const double l =
        (drawn.x[static_cast<std::size_t>(b)] - drawn.x[static_cast<std::size_t>(a)]).norm();
    if (!(std::abs(l - drawn.springs.law(e).rest_length) <= near)) return false;
  }
  return true;
}

}  // namespace qddot::reduce
