#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::measure {

// An upper bound of the fastest frequency [rad/s] that a step of the method has to resolve where
// the motion starts: w_max, but for multirate methods that of the soft forces alone, since they
// take the stiff ones in steps of their own.
double resolved_frequency(const Method& method, const System& system, const Vec& q);

}  // namespace qddot::measure
