#include "experiments/momenta.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace qddot {
namespace {

using Eigen::Vector3d;

// Directions of space that are at right angles to gravity, or all where there is none.
std::vector<Vector3d> level_axes(const Scene& scene) {
  std::vector<Vector3d> axes;
  const Vector3d down = scene.gravity.normalized();
  if (scene.gravity.norm() == 0) {
    for (int d = 0; d < scene.dimension; ++d) axes.push_back(Vector3d::Unit(d));
  } else if (scene.dimension == 3) {
    axes = {down.unitOrthogonal(), down.cross(down.unitOrthogonal())};
  } else if (scene.dimension == 2) {
    axes = {{-down.y(), down.x(), 0}};
  }
  return axes;
}

std::vector<Vector3d> turning_axes(const Scene& scene, bool is_pinned) {
  if (scene.dimension == 1) return {};
  const bool is_heavy = is_pinned && scene.gravity.norm() > 0;
  if (scene.dimension == 2)
    return is_heavy ? std::vector<Vector3d>{} : std::vector{Vector3d(0, 0, 1)};
  if (is_heavy) return {scene.gravity.normalized()};
  return {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
}

double moving_mass(const Node& node) { return node.pinned ? 0 : node.mass; }

// Weighted by the masses.
Vector3d mean(const std::vector<Node>& nodes, Vector3d Node::*vector) {
  double mass = 0;
  Vector3d sum = Vector3d::Zero();
  for (const Node& node : nodes) {
    mass += moving_mass(node);
    sum += moving_mass(node) * (node.*vector);
  }
  return mass > 0 ? Vector3d(sum / mass) : sum;
}

Vec along(const std::vector<Vector3d>& axes, const Vector3d& whole) {
  Vec components(std::ssize(axes));
  for (Index i = 0; i < components.size(); ++i) {
    components[i] = axes[static_cast<std::size_t>(i)].dot(whole);
  }
  return components;
}

}  // namespace

ConservedMomenta::ConservedMomenta(const Scene& scene) {
  std::vector<Vector3d> pins;
  for (const Node& node : scene.nodes) {
    if (node.pinned) pins.push_back(node.position);
  }
  if (pins.empty()) linear_axes_ = level_axes(scene);
  if (!pins.empty()) pin_ = pins.front();
  if (std::ranges::all_of(pins, [&](const Vector3d& pin) { return pin == pins.front(); })) {
    angular_axes_ = turning_axes(scene, !pins.empty());
  }
}

Vector3d ConservedMomenta::centre(const std::vector<Node>& nodes) const {
  return pin_ ? *pin_ : mean(nodes, &Node::position);
}

Vector3d ConservedMomenta::centre_velocity(const std::vector<Node>& nodes) const {
  return pin_ ? Vector3d(Vector3d::Zero()) : mean(nodes, &Node::velocity);
}

Vec ConservedMomenta::linear(const std::vector<Node>& nodes) const {
  Vector3d sum = Vector3d::Zero();
  for (const Node& node : nodes) sum += moving_mass(node) * node.velocity;
  return along(linear_axes_, sum);
}

Vec ConservedMomenta::angular(const std::vector<Node>& nodes) const {
  const Vector3d origin = centre(nodes), drift = centre_velocity(nodes);
  Vector3d sum = Vector3d::Zero();
  for (const Node& node : nodes) {
    sum += moving_mass(node) * (node.position - origin).cross(node.velocity - drift);
  }
  return along(angular_axes_, sum);
}

double ConservedMomenta::linear_size(const std::vector<Node>& nodes) const {
  double sum = 0;
  for (const Node& node : nodes) sum += moving_mass(node) * node.velocity.norm();
  return sum;
}

double ConservedMomenta::angular_size(const std::vector<Node>& nodes) const {
  const Vector3d origin = centre(nodes), drift = centre_velocity(nodes);
  double sum = 0;
  for (const Node& node : nodes) {
    sum += moving_mass(node) * (node.position - origin).norm() * (node.velocity - drift).norm();
  }
  return sum;
}

}  // namespace qddot
