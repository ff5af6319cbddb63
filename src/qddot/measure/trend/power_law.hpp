#pragma once

#include <span>

namespace qddot::inline measure {

// y = c n^exponent, and the 95 % confidence interval of the exponent.
struct PowerLaw {
  double exponent, low, high;
};

// Fits a line to log y over log n by least squares, with Student's interval of its slope. The
// interval takes all deviations for noise. It does not allow for a law that bends, as at the edge
// of a cache. n and y are positive and of equal length. The exponent is NaN for fewer than two
// different n, the interval for fewer than three points.
PowerLaw fit_power_law(std::span<const double> n, std::span<const double> y);

}  // namespace qddot::inline measure
