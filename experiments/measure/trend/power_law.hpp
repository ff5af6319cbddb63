#pragma once

#include <span>

namespace qddot::measure {

// y = c n^exponent, and between which exponents the true one lies with 95 % probability.
struct PowerLaw {
  double exponent, low, high;
};

// The line through log y over log n by least squares, with Student's interval of its slope. That
// takes what is left over for noise: a law that bends, as at the edge of a cache, is outside of it.
// n, y: as many of each, positive. The exponent of fewer than two different n is no number, nor is
// the interval of fewer than three points.
PowerLaw fit_power_law(std::span<const double> n, std::span<const double> y);

}  // namespace qddot::measure
