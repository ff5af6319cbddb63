#include "experiments/error.hpp"

#include <algorithm>
#include <cmath>

namespace qddot {
namespace {

double divided(double error, double scale) { return scale > 0 ? error / scale : error; }

// The largest |a_i - b_i| of the nodes' positions or velocities.
double largest_difference(const std::vector<Node>& a, const std::vector<Node>& b,
                          Eigen::Vector3d Node::*vector) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = (a[i].*vector - b[i].*vector).norm();
    // So that one that is no number is not lost.
    if (!(difference <= largest)) largest = difference;
  }
  return largest;
}

}  // namespace

void extend(Scales& scales, const ReducedScene& scene, const State& state) {
  const auto start = scene.expand(scene.initial()), now = scene.expand(state);
  scales.displacement =
      std::max(scales.displacement, largest_difference(now, start, &Node::position));
  for (const Node& node : now) scales.speed = std::max(scales.speed, node.velocity.norm());
  scales.kinetic = std::max(scales.kinetic, scene.kinetic(state));
}

Errors errors_between(const ReducedScene& scene, const State& state, const State& reference,
                      double energy, const Scales& scales) {
  const auto nodes = scene.expand(state), expected = scene.expand(reference);
  return {divided(largest_difference(nodes, expected, &Node::position), scales.displacement),
          divided(largest_difference(nodes, expected, &Node::velocity), scales.speed),
          divided(std::abs(scene.energy(state) - energy), scales.kinetic)};
}

}  // namespace qddot
