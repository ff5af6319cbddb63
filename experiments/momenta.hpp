#pragma once

#include <vector>

#include "experiments/error.hpp"
#include "src/scene/scene.hpp"

namespace qddot {

// The momenta that a scene's motion keeps, whatever its springs do:
//   nothing pinned:     P(t) - m g t, the linear momentum, m the whole mass, and the angular one L
//                       about the centre of mass;
//   one point pinned:   L about it, along g where there is gravity (pins that are on one line along
//                       g, or on any line where there is no gravity, keep L along that line);
//   else:               none.
class Momenta {
 public:
  Momenta(const Scene& scene, const Scales& scales);

  bool any_kept() const { return keeps_linear_ || !kept_.isZero(); }
  // By how much `now`, at time t [s], differs from `start` in these: P over (whole mass x largest
  // speed), L over (that x the scene's extent), the larger of both.
  double change(const std::vector<Node>& start, const std::vector<Node>& now, double t) const;

 private:
  Eigen::Vector3d linear(const std::vector<Node>& nodes) const;
  // About `centre_`, or where the linear one is kept about the centre of mass.
  Eigen::Vector3d angular(const std::vector<Node>& nodes) const;

  Eigen::Vector3d gravity_;
  bool keeps_linear_ = false;
  Eigen::Matrix3d kept_ = Eigen::Matrix3d::Zero();  // projects L onto what is kept of it
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double mass_ = 0, momentum_scale_ = 1, extent_ = 1;
};

}  // namespace qddot
