#pragma once

#include <vector>

namespace qddot::inline measure {

// Two motions are far apart if their position error is this or more.
constexpr double far_apart = 1e-2;
// Two motions that start one rounding apart part exponentially if their difference grows by more
// than this factor. The difference of regular motions grows in proportion to time, by some
// thousands over a run.
constexpr double exponential_growth = 1e6;

// The exponential parting of two motions that start close to each other.
struct Divergence {
  double horizon;   // t [s] from which on they are `far_apart`; infinite for regular motions
  double lyapunov;  // growth rate of their difference [1/s]; zero for regular motions
};

// Computes the divergence from `differences` (position errors) at ascending `times` [s]; the first
// one, at the start, is above 0. The exponent is the least-squares slope of ln(largest difference
// so far). It is fitted over the second half of the time in which that difference is below
// `far_apart`/10; above, it no longer grows freely. If the motions part exponentially but are not
// apart at the last time, the horizon is extrapolated by that slope.
Divergence divergence(const std::vector<double>& times, const std::vector<double>& differences);

}  // namespace qddot::inline measure
