#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::inline measure {

// The range of h w in which the limit is searched.
constexpr double least_searched_h_omega = 0.01, largest_searched_h_omega = 100;

// The stability limit of the implemented method: the largest h w up to which q'' = -w^2 q does not
// grow. The spectral radius of a step is then at most 1 + 1e-12 (rounding). The limit is searched
// on a grid of 100 points a decade. It is also searched between grid points where the two roots
// meet at 1 or -1, since narrow gaps of instability open there. Bisection refines it to a relative
// 1e-12. Zero if growth fades towards h = 0 as a power of h w, or begins at the least h w. Infinite
// if nothing grows up to the largest h w. `zeta`: the damping ratio of the vibration; see
// linear_step, which throws for damping that the method refuses.
double measured_limit(const Method& method, double zeta = 0);

// The largest step h [s] of an explicit method of fixed steps at which no vibration about q (n)
// grows. Without Damping it is linear_limit() over the largest frequency. With it, leapfrog methods
// have damped_step_limit(); others have the limit of the fastest vibration at that one's own
// damping ratio, so that a slow vibration of much more damping may still grow. The system must have
// K. Throws as quick_frequency() does.
double stable_step(const Method& method, const System& system, const Vec& q);

}  // namespace qddot::inline measure
