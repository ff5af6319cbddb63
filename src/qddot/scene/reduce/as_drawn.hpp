#pragma once

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "qddot/model/spring.hpp"

namespace qddot::reduce {

struct DrawnPart;

// An energy [J] and a bound of its error.
struct BoundedEnergy {
  double value = 0, error = 0;
};

// How far positions [m] and velocities [m/s] may be from the drawn ones after reductions.
struct Tolerances {
  double place = 0, speed = 0;
};

// The tolerances of nodes whose largest coordinate is `farthest` [m], and of whose velocities it is
// `fastest` [m/s]. Each of three mirrors may move a node by the rounding that it allows (see
// drawn_part.hpp), and so may a plane or line that is found. The sum is doubled for turning
// coordinates there and back.
Tolerances tolerances_of(double farthest, double fastest);

// V of springs between nodes, of the masses' weights and of loads: the sum as drawn, and how far
// another way of adding may be from it. Both ends, the rest length and its sum with others may be
// off by the tolerance of positions. Then s = l - l0 is off by D, four times that and rounding, and
//   V by no more than |tau| D + 1/2 tau'(|s| + D) D^2 (Taylor; tau' grows with |s|).
// Laws, masses, gravity and loads may be off by `rounding` (see drawn_part.hpp). A sum of n terms
// may be off by n eps of their sizes, each at most as large as at the largest coordinate.
class DrawnPotential {
 public:
  // `farthest`: the largest coordinate [m].
  DrawnPotential(const Eigen::Vector3d& gravity, const Tolerances& tolerances, double farthest)
      : gravity_(gravity), weight_(gravity.norm()), place_(tolerances.place), farthest_(farthest) {}

  // Adds a spring of length l [m].
  void add(const SpringLaw& law, double l) {
    const double off = 4 * (place_ + eps * (l + law.rest_length));
    const double strained = std::abs(l - law.rest_length) + off;
    const double energy = law.energy(l);
    sum_.value += energy;
    sum_.error +=
        (std::abs(law.tension(l)) + 0.5 * law.tangent(law.rest_length + strained) * off) * off;
    underflows_ += 1 + strained * strained;
    sizes_ += energy;
    ++terms_;
  }
  // Adds a node at x [m] with its load [N].
  void add(double mass, const Eigen::Vector3d& x, const Eigen::Vector3d& load) {
    const double load_size = load.norm(), pull = mass * weight_ + load_size;
    sum_.value -= mass * gravity_.dot(x) + load.dot(x);
    sum_.error += pull * place_;
    underflows_ += (1 + weight_ + load_size) * (1 + farthest_);
    sizes_ += 4 * pull * farthest_;
    ++terms_;
  }
  BoundedEnergy sum() const;

 private:
  static constexpr double eps = 0x1p-52;

  Eigen::Vector3d gravity_;
  double weight_, place_, farthest_;
  BoundedEnergy sum_{};
  double sizes_ = 0, underflows_ = 0;
  std::size_t terms_ = 0;
};

// T of masses, likewise: off by m |v| D + 1/2 m D^2, with D the tolerance of speeds.
class DrawnKinetic {
 public:
  explicit DrawnKinetic(const Tolerances& tolerances) : off_(tolerances.speed) {}

  void add(double mass, const Eigen::Vector3d& v) {
    const double square = v.squaredNorm();
    sum_.value += 0.5 * mass * square;
    sum_.error += mass * (std::sqrt(square) + 0.5 * off_) * off_;
    underflows_ += 1 + square;
    ++terms_;
  }
  BoundedEnergy sum() const;

 private:
  double off_;
  BoundedEnergy sum_{};
  double underflows_ = 0;
  std::size_t terms_ = 0;
};

// The energies of a part as drawn, and the tolerances of its places and speeds.
struct DrawnEnergies {
  explicit DrawnEnergies(const DrawnPart& drawn);

  Tolerances tolerances;
  BoundedEnergy kinetic, potential;
};

// Whether two energies differ by more than the error. False if one is NaN, which is found and
// reported elsewhere.
inline bool differs(const BoundedEnergy& drawn, double reduced) {
  return std::abs(reduced - drawn.value) > drawn.error;
}

}  // namespace qddot::reduce
