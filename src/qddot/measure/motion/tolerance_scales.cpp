#include "qddot/measure/motion/tolerance_scales.hpp"

#include <algorithm>
#include <cmath>

namespace qddot::inline measure {
namespace {

double extent(const std::vector<Node>& nodes) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (const Node& node : nodes) {
    low = low.cwiseMin(node.position);
    high = high.cwiseMax(node.position);
  }
  return nodes.empty() ? 0 : (high - low).maxCoeff();
}

double fastest(const std::vector<Node>& nodes) {
  double speed = 0;
  for (const Node& node : nodes) speed = std::max(speed, node.velocity.norm());
  return speed;
}

double largest_acceleration(const System& system, const State& state) {
  Vec f(system.size());
  system.force(state, f);
  double largest = 0;
  for (Index i = 0; i < system.size(); ++i) {
    if (system.mass()[i] > 0) largest = std::max(largest, std::abs(f[i]) / system.mass()[i]);
  }
  return largest;
}

}  // namespace

Options with_tolerance_scales(Options options, const Model& scene) {
  const auto nodes = scene.expand_beside_falls(scene.initial());
  const double length = extent(nodes);
  options.length = length > 0 ? length : 1;
  const double a = largest_acceleration(scene.system(), scene.initial());
  const double speed = std::max(fastest(nodes), std::sqrt(a * options.length));
  options.speed = speed > 0 && std::isfinite(speed) ? speed : options.length;
  return options;
}

}  // namespace qddot::inline measure
