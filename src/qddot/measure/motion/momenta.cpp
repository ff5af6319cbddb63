#include "qddot/measure/motion/momenta.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace qddot::inline measure {
namespace {

using Eigen::Vector3d;

// Whether two directions are parallel up to rounding and sign; zero is parallel to all.
bool parallel(const Vector3d& a, const Vector3d& b) {
  return a.cross(b).norm() <= 1e-12 * a.norm() * b.norm();
}

const std::vector<Vector3d>& all_axes() {
  static const std::vector<Vector3d> axes = {Vector3d::UnitX(), Vector3d::UnitY(),
                                             Vector3d::UnitZ()};
  return axes;
}

// The axes about which constant forces with these directions and the springs to pins at these
// points have no torque.
std::vector<Vector3d> turning_axes(const std::vector<Vector3d>& pins,
                                   const std::vector<Vector3d>& pulls) {
  Vector3d line = Vector3d::Zero();  // along which all pins are
  for (const Vector3d& pin : pins) {
    if (line.isZero()) line = pin - pins.front();
    if (!parallel(line, pin - pins.front())) return {};
  }
  for (const Vector3d& pull : pulls) {
    if (!parallel(line, pull)) return {};
    if (line.isZero()) line = pull;
  }
  return line.isZero() ? all_axes() : std::vector<Vector3d>{line.normalized()};
}

double moving_mass(const Node& node) { return node.pinned ? 0 : node.mass; }

Vec along(const std::vector<Vector3d>& axes, const Vector3d& whole) {
  Vec components(std::ssize(axes));
  std::ranges::transform(axes, components.begin(),
                         [&](const Vector3d& axis) { return axis.dot(whole); });
  return components;
}

}  // namespace

Momenta::Momenta(const Scene& scene) : gravity_(scene.gravity) {
  Eigen::AlignedBox3d box;
  std::vector<Vector3d> pins, pulls;
  for (const Node& node : scene.nodes) {
    box.extend(node.position);
    mass_ += moving_mass(node);
    if (node.pinned) pins.push_back(node.position);
    const Vector3d load = node.acting_load();
    if (!load.isZero(0)) pulls.push_back(load);
    load_ += load;
  }
  if (!box.isEmpty() && box.diagonal().norm() > 0) extent_ = box.diagonal().norm();
  if (scene.air_damping > 0 || is_driven(scene)) return;
  if (!pins.empty()) pin_ = pins.front(), pulls.push_back(gravity_);
  if (pins.empty()) {
    linear_axes_.assign(all_axes().begin(), all_axes().begin() + scene.dimension);
  }
  if (scene.dimension == 1) return;  // nothing turns
  const bool turns = std::ranges::any_of(scene.springs, [](const Spring& spring) {
    return spring.law.damping > 0 && spring.law.rest_length == 0;
  });
  if (turns) return;
  angular_axes_ = turning_axes(pins, pulls);
  if (scene.dimension == 2) {
    std::erase_if(angular_axes_, [](const Vector3d& axis) { return axis.z() == 0; });
  }
}

Vector3d Momenta::centre(const std::vector<Node>& nodes) const {
  if (!has_linear() || mass_ == 0) return pin_;
  Vector3d sum = Vector3d::Zero();
  for (const Node& node : nodes) sum += moving_mass(node) * node.position;
  return sum / mass_;
}

Vector3d Momenta::centre_velocity(const std::vector<Node>& nodes) const {
  Vector3d sum = Vector3d::Zero();
  if (!has_linear() || mass_ == 0) return sum;
  for (const Node& node : nodes) sum += moving_mass(node) * node.velocity;
  return sum / mass_;
}

Vec Momenta::linear(const std::vector<Node>& nodes, double t) const {
  Vector3d sum = -mass_ * t * gravity_ - t * load_;
  for (const Node& node : nodes) sum += moving_mass(node) * node.velocity;
  return along(linear_axes_, sum);
}

Vec Momenta::angular(const std::vector<Node>& nodes) const {
  const Vector3d origin = centre(nodes), drift = centre_velocity(nodes);
  Vector3d sum = Vector3d::Zero();
  for (const Node& node : nodes) {
    sum += moving_mass(node) * (node.position - origin).cross(node.velocity - drift);
  }
  return along(angular_axes_, sum);
}

double Momenta::linear_size(const std::vector<Node>& nodes) const {
  double sum = 0;
  for (const Node& node : nodes) sum += moving_mass(node) * node.velocity.norm();
  return sum;
}

double Momenta::angular_size(const std::vector<Node>& nodes) const {
  const Vector3d origin = centre(nodes), drift = centre_velocity(nodes);
  double sum = 0;
  for (const Node& node : nodes) {
    sum += moving_mass(node) * (node.position - origin).norm() * (node.velocity - drift).norm();
  }
  return sum;
}

double Momenta::change(const std::vector<Node>& start, const std::vector<Node>& now, double t,
                       double speed) const {
  const double scale = mass_ * speed > 0 ? mass_ * speed : 1;
  return std::max((linear(now, t) - linear(start, 0)).norm() / scale,
                  (angular(now) - angular(start)).norm() / (scale * extent_));
}

}  // namespace qddot::inline measure
