#pragma once

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::measure {

// How many times farther than chance puts it a run's energy may be from the reference's modes.
constexpr double most_of_chance = 10;

// What the accuracy of a run is judged by: the error of the positions at its end or, where that is
// beyond the horizon and they are known to nobody, the largest error of the energy on the way. As
// nothing keeps its energy better than what does not move, that is infinite for a run whose energy
// is in other modes than the reference's.
double judged_error(const Point& point, const Reference& reference);

// The least that such an error can be told from zero.
double certified(const Reference& reference);

// What is known of an error e that was measured against a reference which itself is off by up to c:
// it is at least e - c, or 0, and at most e + c.
struct Known {
  double at_least = 0, at_most = 0;
};
Known known(double error, double certified);

// Whether what is not known of an error is a tenth of it or more.
bool is_uncertain(double error, double certified);

// "position" or "energy".
const char* judged_by(const Reference& reference);

}  // namespace qddot::measure
