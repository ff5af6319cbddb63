#include "experiments/momenta.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace qddot {
namespace {

// Whether two directions are the same but for rounding, either way round; a zero one is any.
bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() <= 1e-12 * a.norm() * b.norm();
}

}  // namespace

Momenta::Momenta(const Scene& scene, const Scales& scales) : gravity_(scene.gravity) {
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector3d> pins;
  for (const Node& node : scene.nodes) {
    box.extend(node.position);
    if (!node.pinned) mass_ += node.mass;
    if (node.pinned) pins.push_back(node.position);
  }
  if (!box.isEmpty() && box.diagonal().norm() > 0) extent_ = box.diagonal().norm();
  if (mass_ * scales.speed > 0) momentum_scale_ = mass_ * scales.speed;

  keeps_linear_ = pins.empty();
  Eigen::Vector3d line = Eigen::Vector3d::Zero();  // along which all pins are
  for (const Eigen::Vector3d& pin : pins) {
    centre_ = pins.front();
    if (line.isZero()) line = pin - centre_;
    if (!parallel(line, pin - centre_)) return;
  }
  if (!keeps_linear_ && !parallel(line, gravity_)) return;
  if (!keeps_linear_ && line.isZero()) line = gravity_;
  if (scene.dimension == 1) return;  // nothing turns
  if (keeps_linear_ || line.isZero()) {
    kept_.setIdentity();
  } else {
    kept_ = line * line.transpose() / line.squaredNorm();
  }
}

Eigen::Vector3d Momenta::linear(const std::vector<Node>& nodes) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Node& node : nodes) {
    if (!node.pinned) sum += node.mass * node.velocity;
  }
  return sum;
}

Eigen::Vector3d Momenta::angular(const std::vector<Node>& nodes) const {
  Eigen::Vector3d centre = centre_;
  if (keeps_linear_ && mass_ > 0) {
    centre.setZero();
    for (const Node& node : nodes) centre += node.mass / mass_ * node.position;
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Node& node : nodes) {
    if (!node.pinned) sum += node.mass * (node.position - centre).cross(node.velocity);
  }
  return sum;
}

double Momenta::change(const std::vector<Node>& start, const std::vector<Node>& now,
                       double t) const {
  double largest = 0;
  if (keeps_linear_) {
    largest = (linear(now) - linear(start) - mass_ * t * gravity_).norm() / momentum_scale_;
  }
  const Eigen::Vector3d turned = kept_ * (angular(now) - angular(start));
  return std::max(largest, turned.norm() / (momentum_scale_ * extent_));
}

}  // namespace qddot
