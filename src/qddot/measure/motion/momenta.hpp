#pragma once

#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline measure {

// The momenta that are conserved in a scene's motion, whatever its springs do:
//   nothing pinned:     the linear momentum, as P(t) - F t with F the weight and all loads, and the
//                       angular momentum L about the centre of mass;
//   one point pinned:   L about that point; with gravity g, the component of L along g alone;
//   pins on one line:   L along the line, if it is parallel to g or there is no gravity;
//   else:               none.
// Loads act on L as gravity does, and also where nothing is pinned: only a component along all of
// them is kept. Air takes all of both. Dashpots of springs with rest lengths take none; one of a
// spring without acts in all directions and takes L.
class Momenta {
 public:
  explicit Momenta(const Scene& scene);
  // None: those of forces of which nothing is known.
  Momenta() = default;

  bool has_linear() const { return !linear_axes_.empty(); }
  bool has_angular() const { return !angular_axes_.empty(); }
  bool any_kept() const { return has_linear() || has_angular(); }

  // The components of the conserved momenta at time t [s], in [kg m/s] and [kg m^2/s].
  Vec linear(const std::vector<Node>& nodes, double t) const;
  Vec angular(const std::vector<Node>& nodes) const;

  // The sizes that changes are compared with: the sum of the magnitudes of all nodes' momenta.
  double linear_size(const std::vector<Node>& nodes) const;
  double angular_size(const std::vector<Node>& nodes) const;

  // The relative change of the conserved momenta from `start` to `now`, at time t [s]. P is divided
  // by (total mass x `speed` [m/s]), L by (that x the scene's extent); the larger of both.
  double change(const std::vector<Node>& start, const std::vector<Node>& now, double t,
                double speed) const;

 private:
  Eigen::Vector3d centre(const std::vector<Node>& nodes) const;
  Eigen::Vector3d centre_velocity(const std::vector<Node>& nodes) const;

  std::vector<Eigen::Vector3d> linear_axes_, angular_axes_;
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero(), load_ = Eigen::Vector3d::Zero(),
                  pin_ = Eigen::Vector3d::Zero();
  double mass_ = 0, extent_ = 1;
};

}  // namespace qddot::inline measure
