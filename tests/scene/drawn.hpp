#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/model.hpp"

namespace qddot {
inline namespace tests {

inline Scene draw(const std::string& generator, const GeneratorValues& values = {}) {
  return generate(*find_generator(generator), values, "test");
}

// The scene with every spring at so many times its rest length.
inline Scene stretched(Scene scene, double stretch) {
  for (Spring& spring : scene.springs) spring.law.rest_length /= stretch;
  return scene;
}

// The scene moved and turned in space as a whole.
inline Scene turned(Scene scene, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& shift) {
  for (Node& node : scene.nodes) {
    node.position = rotation * node.position + shift;
    node.velocity = rotation * node.velocity;
    node.load = rotation * node.load;
  }
  scene.gravity = rotation * scene.gravity;
  scene.dimension = 3;
  return scene;
}
inline Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
}

// The same scene with its nodes in another order: node i becomes order[i].
inline Scene renumbered(const Scene& scene, const std::vector<std::size_t>& order) {
  Scene other = scene;
  for (std::size_t i = 0; i < order.size(); ++i) other.nodes[order[i]] = scene.nodes[i];
  for (Spring& spring : other.springs) {
    for (std::size_t& node : spring.nodes) node = order[node];
  }
  return other;
}

// A square of nodes with a cross in it. It is stretched, so that it pulses, and has four mirrors:
// two along the axes, two along the diagonals.
inline Scene square(int dimension = 2) {
  Scene scene{.dimension = dimension};
  for (const auto& [x, y] : {std::pair(-1., -1.), {1., -1.}, {1., 1.}, {-1., 1.}, {0., 0.}}) {
    scene.nodes.push_back({.position = {1.2 * x, 1.2 * y, 0}, .mass = 0.5});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    scene.springs.push_back({{i, (i + 1) % 4}, {.stiffness = 80, .rest_length = 2}});
    scene.springs.push_back({{i, 4}, {.stiffness = 50, .rest_length = 1.5, .quartic = 20}});
  }
  return scene;
}

inline bool has(const Model& scene, Reduction reduction) {
  return std::ranges::count(scene.findings(), reduction, &Finding::reduction) > 0;
}

// The sentence on a reduction that was found; empty if it was not.
inline std::string sentence(const Model& scene, Reduction reduction) {
  for (const Finding& finding : scene.findings()) {
    if (finding.reduction == reduction) return finding.what;
  }
  return "";
}

// Another state of the reduced scene: every coordinate and velocity changed by up to `change`.
inline State moved(const Model& reduced, double change, std::mt19937& random) {
  std::uniform_real_distribution<double> part(-change, change);
  State state = reduced.initial();
  for (double& x : state.q) x += part(random);
  for (double& v : state.v) v += part(random);
  return state;
}

// The nodes as drawn, but pinned ones rest.
inline std::vector<Node> at_start(const Scene& scene) {
  std::vector<Node> nodes = scene.nodes;
  for (Node& node : nodes) {
    if (node.pinned) node.velocity.setZero();
  }
  return nodes;
}

// V of all springs and of the weights and loads of the free nodes, spring by spring over all nodes.
inline double potential_by_hand(const Scene& scene, const std::vector<Node>& nodes) {
  double v = 0;
  for (const auto& [ends, law, holds, stiff] : scene.springs)
    v += law.energy((nodes[ends[1]].position - nodes[ends[0]].position).norm());
  for (const Node& node : nodes) {
    if (!node.pinned) v -= (node.mass * scene.gravity + node.load).dot(node.position);
  }
  return v;
}
inline double kinetic_by_hand(const std::vector<Node>& nodes) {
  double energy = 0;
  for (const Node& node : nodes) energy += 0.5 * node.mass * node.velocity.squaredNorm();
  return energy;
}

// The largest distance between the same nodes of two states, and of their velocities.
inline double farthest(const std::vector<Node>& a, const std::vector<Node>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double apart =
        std::max((a[i].position - b[i].position).norm(), (a[i].velocity - b[i].velocity).norm());
    if (!(apart <= largest)) largest = apart;
  }
  return largest;
}

}  // namespace tests
}  // namespace qddot
