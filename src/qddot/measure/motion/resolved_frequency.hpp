#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::inline measure {

// An upper bound of the largest frequency [rad/s] that a step of the method has to resolve at the
// start. This is w_max, or that of the soft forces alone for multirate methods, which integrate the
// stiff ones with inner steps.
double resolved_frequency(const Method& method, const System& system, const Vec& q);

}  // namespace qddot::inline measure
