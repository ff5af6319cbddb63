#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// The largest step h [s] at which a leapfrog method lets no vibration at q (n) grow, if friction is
// late by `lag` half steps (Method::friction_lag). With z = (1 + s)/(1 - s) for the factor z of a
// step, the linearised method is a damped system in s, and stable where
//   4 M - 2 lag h C + h^2 K
// is positive definite: where springs of stiffness k + 2 lag c/h are stable without damping. So h
// is 2/w(h) with the largest frequency w of these springs, by iteration from above. To about 1e-4,
// as quick_frequency(). The system must have K; infinite if nothing vibrates. Throws as
// quick_frequency() does.
double damped_step_limit(const System& system, const Vec& q, double lag);

}  // namespace qddot
