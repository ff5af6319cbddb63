#pragma once

#include <vector>

#include <Eigen/Core>

#include "qddot/scene/reduce/fall.hpp"
#include "qddot/scene/reduce/part_members.hpp"
#include "qddot/scene/reduce/part_springs.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// A part of a scene with all that acts on it, numbered anew: its nodes, the pinned nodes at the
// other ends of its springs, gravity and loads.
struct DrawnPart {
  // The scene's numbers: free nodes, then pinned ones; both ascend unless the former were scattered
  // (see node_order.hpp).
  std::vector<std::size_t> nodes{};
  std::size_t free = 0;  // how many are free
  // The place of x = 0 in the scene: zero or, if the part is far from zero for its size, a node of
  // the part. Positions are then exact differences. Rounding and tolerances scale with the part's
  // size instead of its distance from the scene's origin.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> x{};     // of all of them
  std::vector<Eigen::Vector3d> v{};     // of all of them; 0 where pinned; empty if all are 0
  std::vector<double> mass{};           // of all of them; 0 where pinned
  std::vector<Eigen::Vector3d> load{};  // [N], of all of them; 0 where pinned; empty if all are
  PartSprings springs{};                // between numbers of this part
  Eigen::Vector3d gravity =
      Eigen::Vector3d::Zero();  // zero where there is nothing that it could pull
  double gravity_noise = 0;     // the size of gravity [m/s^2] below which it is rounding
  Fall fall{};                  // the frame that v and gravity are seen from, see let_fall
  double air_damping = 0;       // alpha [1/s], set by the caller
  bool offers_split = false;    // whether its system is to offer Split
  // The scene's curves, if anything in the part depends on time, and the curve of each node and of
  // gravity, or -1; see Scene.
  std::vector<TimeCurve> curves{};
  std::vector<int> curve_of{};
  int gravity_curve = -1;

  bool is_driven() const { return !curves.empty(); }
  // The curve of a node, or nullptr.
  const TimeCurve* curve(std::size_t i) const {
    return is_driven() && curve_of[i] >= 0 ? &curves[static_cast<std::size_t>(curve_of[i])]
                                           : nullptr;
  }
  const TimeCurve* curve_of_gravity() const {
    return gravity_curve >= 0 ? &curves[static_cast<std::size_t>(gravity_curve)] : nullptr;
  }
  // Whether a load is not zero.
  bool is_loaded() const { return !load.empty(); }
  Eigen::Vector3d load_of(std::size_t i) const { return of(load, i); }
  Eigen::Vector3d velocity_of(std::size_t i) const { return of(v, i); }

 private:
  static Eigen::Vector3d of(const std::vector<Eigen::Vector3d>& vectors, std::size_t i) {
    return vectors.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : vectors[i];
  }
};

// Makes the part of these members, whose numbers are those of the scene's nodes and springs. It
// refers to `springs`. Gravity and what changes with time are those of the scene.
DrawnPart drawn_part(PartMembers members, const std::vector<Node>& nodes,
                     const std::vector<Spring>& springs, const Scene& scene);

// The springs of the part once more, found among all by its nodes.
PartSprings drawn_springs(const DrawnPart& drawn, const std::vector<Node>& nodes,
                          const std::vector<Spring>& springs);

// The relative error that rounding may have left in coordinates that come from a few operations.
inline constexpr double rounding = 64 * 0x1p-52;

// The largest coordinate, in absolute value.
double largest_coordinate(const std::vector<Eigen::Vector3d>& vectors);

}  // namespace qddot::reduce
