#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::measure {

// How far a method of fixed steps misses the frequency of q'' = -w^2 q at h w = `h_omega`,
// relative:
//   |log(r) / (i h w) - 1|,
// r the root of its step (see LinearStep) next to exp(i h w). The real part is the error of the
// phase, the imaginary one the damping: over a time t, a vibration of amplitude a is off by about
// a w t times this. Infinite where vibrations grow, and for methods without such a step. Found by
// running the method, to some percent; small ones by the method's order. Thread-safe.
double frequency_error(const Method& method, double h_omega);

// The largest h w up to which that is at most `error`; 0 where there is none.
double largest_h_omega(const Method& method, double error);

}  // namespace qddot::measure
