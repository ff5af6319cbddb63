#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// An energy [J] and a bound of its error.
struct BoundedEnergy {
  double value = 0, error = 0;
};

// How far positions [m] and velocities [m/s] may be from the drawn ones after reductions.
struct Tolerances {
  double place = 0, speed = 0;
};

// The tolerances of nodes at x [m] with velocities v [m/s]. Each of three mirrors may move a node
// by the rounding that it allows (see drawn_part.hpp), and so may a plane or line that is found.
// The sum is doubled for turning coordinates there and back.
Tolerances tolerances_of(const std::vector<Eigen::Vector3d>& x,
                         const std::vector<Eigen::Vector3d>& v);

// V of springs between nodes at x, of the masses' weights and of loads: the sum as drawn, and how
// far another way of adding may be from it. Both ends, the rest length and its sum with others may
// be off by the tolerance of positions. Then s = l - l0 is off by D, four times that and rounding,
// and
//   V by no more than |tau| D + 1/2 tau'(|s| + D) D^2 (Taylor; tau' grows with |s|).
// Laws, masses, gravity and loads may be off by `rounding` (see drawn_part.hpp). A sum of n terms
// may be off by n eps of their sizes, each at most as large as at the largest coordinate.
BoundedEnergy potential_of(std::span<const Spring> springs, const std::vector<Eigen::Vector3d>& x,
                           const std::vector<double>& mass, const Eigen::Vector3d& gravity,
                           const std::vector<Eigen::Vector3d>& load, const Tolerances& tolerances);

// T of the masses at velocities v, likewise: off by m |v| D + 1/2 m D^2, with D the tolerance of
// speeds.
BoundedEnergy kinetic_of(const std::vector<Eigen::Vector3d>& v, const std::vector<double>& mass,
                         const Tolerances& tolerances);

// Whether two energies differ by more than the error. False if one is NaN, which is found and
// reported elsewhere.
inline bool differs(const BoundedEnergy& drawn, double reduced) {
  return std::abs(reduced - drawn.value) > drawn.error;
}

}  // namespace qddot::reduce
