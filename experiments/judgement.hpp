#pragma once

#include "experiments/measurement.hpp"

namespace qddot {

// What the accuracy of a run is judged by: the error of the positions at its end or, where that is
// beyond the horizon and they are known to nobody, the largest error of the energy on the way.
double judged_error(const Point& point, const Reference& reference);

// The least that such an error can be told from zero.
double certified(const Reference& reference);

// "position" or "energy".
const char* judged_by(const Reference& reference);

}  // namespace qddot
