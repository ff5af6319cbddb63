#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::inline measure {

// The relative error of a fixed-step method's frequency for q'' = -w^2 q at h w = `h_omega`:
//   |log(r) / (i h w) - 1|,
// where r is the root of its step (see LinearStep) nearest to exp(i h w). The real part is the
// error of the phase, the imaginary part the damping. After a time t, a vibration of amplitude a
// has an error of about a w t times this. The value is infinite if vibrations grow, and for methods
// without such a step. It comes from steps of the method and is accurate to some percent; small
// errors follow from the order. Thread-safe.
double frequency_error(const Method& method, double h_omega);

// The largest h w up to which frequency_error is at most `error`; 0 if there is none.
double largest_h_omega(const Method& method, double error);

}  // namespace qddot::inline measure
