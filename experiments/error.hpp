#pragma once

#include "src/scene/reduce.hpp"

namespace qddot {

// What errors are measured against: magnitudes of a motion over its run.
struct Scales {
  double displacement = 0;  // largest |x - x(0)| of a node [m]
  double speed = 0;         // largest |v| of a node [m/s]
  double kinetic = 0;       // largest kinetic energy [J]
};

// Errors of a state against another at the same time, over all nodes of the scene, whatever its
// unknowns are; each divided by its scale, or as it is where that is zero (nothing moves).
struct Errors {
  double position = 0;  // max over nodes of |x - x_ref|
  double velocity = 0;  // max over nodes of |v - v_ref|
  double energy = 0;    // |E - E_ref|
};

// Takes one more state of the motion from `initial` into the scales.
void extend(Scales& scales, const ReducedScene& scene, const State& state);

// `energy`: E_ref [J].
Errors errors_between(const ReducedScene& scene, const State& state, const State& reference,
                      double energy, const Scales& scales);

}  // namespace qddot
