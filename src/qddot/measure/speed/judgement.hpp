#pragma once

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline measure {

// A run's modal shares may differ from the reference's by this many times the difference by chance.
constexpr double most_of_chance = 10;

// The error that decides a run's accuracy: that of the positions at its end. If the end is beyond
// the horizon, positions are unknown; then it is the largest error of the energy during the run. A
// run that hardly moves keeps its energy well. So the error is infinite if the run's energy is in
// other modes than the reference's.
double judged_error(const Point& point, const Reference& reference);

// The certified error of the reference, of the same kind; smaller errors cannot be told from zero.
double certified(const Reference& reference);

// The bounds of a true error. If the error e was measured against a reference with an error of up
// to c, they are max(e - c, 0) and e + c.
struct Known {
  double at_least = 0, at_most = 0;
};
Known known(double error, double certified);

// Whether the uncertainty of an error is a tenth of it or more.
bool is_uncertain(double error, double certified);

// "position" or "energy".
const char* judged_by(const Reference& reference);

}  // namespace qddot::inline measure
