#pragma once

#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::measure {

// The momenta that a scene's motion keeps, whatever its springs do:
//   nothing pinned:     P(t) - m g t, the linear momentum, m the whole mass, and the angular one L
//                       about the centre of mass;
//   one point pinned:   L about it, along g where there is gravity (pins that are on one line along
//                       g, or on any line where there is no gravity, keep L along that line);
//   else:               none.
class Momenta {
 public:
  explicit Momenta(const Scene& scene);

  bool has_linear() const { return !linear_axes_.empty(); }
  bool has_angular() const { return !angular_axes_.empty(); }
  bool any_kept() const { return has_linear() || has_angular(); }

  // What is kept at time t [s], in components: [kg m/s] and [kg m^2/s].
  Vec linear(const std::vector<Node>& nodes, double t) const;
  Vec angular(const std::vector<Node>& nodes) const;

  // What they are small or large by: the sum of the magnitudes of all nodes' own.
  double linear_size(const std::vector<Node>& nodes) const;
  double angular_size(const std::vector<Node>& nodes) const;

  // By how much `now`, at time t [s], differs from `start` in these: P over (whole mass x `speed`
  // [m/s]), L over (that x the scene's extent), the larger of both.
  double change(const std::vector<Node>& start, const std::vector<Node>& now, double t,
                double speed) const;

 private:
  Eigen::Vector3d centre(const std::vector<Node>& nodes) const;
  Eigen::Vector3d centre_velocity(const std::vector<Node>& nodes) const;

  std::vector<Eigen::Vector3d> linear_axes_, angular_axes_;
  Eigen::Vector3d gravity_, pin_ = Eigen::Vector3d::Zero();
  double mass_ = 0, extent_ = 1;
};

}  // namespace qddot::measure
