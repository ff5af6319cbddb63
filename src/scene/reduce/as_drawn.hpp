#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// An energy [J] and by how much it may be off.
struct BoundedEnergy {
  double value = 0, error = 0;
};

// How far positions [m] and velocities [m/s] may be from the drawn ones after reductions.
struct Tolerances {
  double place = 0, speed = 0;
};

// Three mirrors may each move a node by the rounding that they allow (see drawn_part.hpp), and a
// plane or line that is found by one more; as much again is for turning coordinates there and back.
Tolerances tolerances_of(const std::vector<Eigen::Vector3d>& x,
                         const std::vector<Eigen::Vector3d>& v);

// V of springs between nodes at x, and weights of the masses: the sum as drawn, and how far from it
// another way of adding up may come. Both ends, the rest length and its sum with others may be off
// by the tolerance of positions, which changes s = l - l0 by D, four times that and rounding, and
//   V by no more than |tau| D + 1/2 tau'(|s| + D) D^2 (Taylor; tau' grows with |s|).
// Laws, masses and gravity may be off by `rounding` (see drawn_part.hpp), a sum of n terms by n eps
// of their sizes, each at most as large as at the largest coordinate.
BoundedEnergy potential_of(std::span<const Spring> springs, const std::vector<Eigen::Vector3d>& x,
                           const std::vector<double>& mass, const Eigen::Vector3d& gravity,
                           const Tolerances& tolerances);

// T of the masses at velocities v, likewise: off by m |v| D + 1/2 m D^2, D the tolerance of speeds.
BoundedEnergy kinetic_of(const std::vector<Eigen::Vector3d>& v, const std::vector<double>& mass,
                         const Tolerances& tolerances);

// Whether two energies differ by more than the error. No: where one is no number; that is found
// elsewhere, and told as what it is.
inline bool differs(const BoundedEnergy& drawn, double reduced) {
  return std::abs(reduced - drawn.value) > drawn.error;
}

}  // namespace qddot::reduce
