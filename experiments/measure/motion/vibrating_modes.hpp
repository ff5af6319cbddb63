#pragma once

#include <vector>

#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::measure {

// A natural mode of a scene: it vibrates as x cos(w t).
struct Mode {
  int rank;      // from 1, the lowest
  double omega;  // w [rad/s], > 0
  double part;   // w / w_max
  Vec shape;     // x, x'Mx = 1 (x in kg^-1/2)
};

// Up to `count` of the modes that vibrate about q, ascending, the lowest and the highest among
// them: of a system of up to 1500 unknowns spread evenly over the logarithm of the frequency, of a
// larger one both ends. Modes with w below 1e-6 of the largest are left out: a run that follows the
// fastest does not see them move.
std::vector<Mode> sampled_modes(const System& system, const Vec& q, int count);

// The largest rate [1/s] at which a motion leaves q, where compressed springs push to the side:
// the root of the largest eigenvalue of M^-1 K(q), or zero where that is not positive whatever
// rounding does.
double buckling_rate(const System& system, const Vec& q);

}  // namespace qddot::measure
