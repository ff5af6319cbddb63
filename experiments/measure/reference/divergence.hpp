#pragma once

#include <vector>

namespace qddot::measure {

// Position errors so large tell two motions apart.
constexpr double apart = 1e-2;
// Two motions that were one rounding apart and have parted by more than this factor have done so
// exponentially: regular ones part in proportion to time, by some thousands over their runs.
constexpr double exponential_growth = 1e6;

// How two motions part that start next to each other.
struct Divergence {
  double horizon;   // t [s] from which on they are `apart`; infinite for regular motions
  double lyapunov;  // [1/s], at which their difference has grown; zero for regular motions
};

// From the differences (position errors) at the times [s], ascending; the first one is the start's,
// above 0. The exponent is the slope, by least squares, of ln(largest difference so far) over the
// later half of the time in which that is below a tenth of `apart`; above, it no longer grows
// freely. Where they part exponentially but are not apart at the last time, the horizon is where
// that slope leads.
Divergence divergence(const std::vector<double>& times, const std::vector<double>& differences);

}  // namespace qddot::measure
