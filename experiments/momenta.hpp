#pragma once

#include <optional>
#include <vector>

#include "src/model/system.hpp"
#include "src/scene/scene.hpp"

namespace qddot {

// What of the linear and angular momentum of a scene stays, by its symmetries:
//   linear: where no node is pinned, in the directions without gravity;
//   angular: about the centre of mass where no node is pinned; about the pins where all are at one
//   point, there in the direction of gravity only, if there is any.
class ConservedMomenta {
 public:
  explicit ConservedMomenta(const Scene& scene);

  bool has_linear() const { return !linear_axes_.empty(); }
  bool has_angular() const { return !angular_axes_.empty(); }

  // Their components that stay [kg m/s] and [kg m^2/s].
  Vec linear(const std::vector<Node>& nodes) const;
  Vec angular(const std::vector<Node>& nodes) const;

  // What they are small or large by: the sum of the magnitudes of all nodes' own.
  double linear_size(const std::vector<Node>& nodes) const;
  double angular_size(const std::vector<Node>& nodes) const;

 private:
  Eigen::Vector3d centre(const std::vector<Node>& nodes) const;
  Eigen::Vector3d centre_velocity(const std::vector<Node>& nodes) const;

  std::vector<Eigen::Vector3d> linear_axes_, angular_axes_;
  std::optional<Eigen::Vector3d> pin_;
};

}  // namespace qddot
