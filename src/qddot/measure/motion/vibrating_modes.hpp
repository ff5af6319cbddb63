#pragma once

#include <vector>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// A natural mode of a scene: it vibrates as x cos(w t).
struct Mode {
  int rank;         // from 1, the lowest
  double omega;     // w [rad/s], > 0
  double part;      // w / w_max
  Vec shape;        // x, x'Mx = 1 (x in kg^-1/2)
  double zeta = 0;  // x'Cx/(2 w), the mode's own damping ratio; zero without Damping
};

// Up to `count` of the modes that vibrate about q, in ascending order, with the lowest and the
// highest. Systems of up to 1500 unknowns give modes spread evenly over the logarithm of the
// frequency; larger ones give both ends of the spectrum. Modes with w below 1e-6 w_max are left
// out: they do not move in a run that resolves the fastest mode.
std::vector<Mode> sampled_modes(const System& system, const Vec& q, int count);

// The largest rate [1/s] at which a motion leaves q, where compressed springs push sideways: the
// square root of the largest eigenvalue of M^-1 K(q). Zero if rounding may have made it positive.
double buckling_rate(const System& system, const Vec& q);

// An upper bound of the largest frequency [rad/s] that a step of the method has to resolve at the
// start. This is w_max, or that of the soft forces alone for multirate methods, which integrate the
// stiff ones with inner steps.
double resolved_frequency(const Method& method, const System& system, const Vec& q);

}  // namespace qddot::inline measure
