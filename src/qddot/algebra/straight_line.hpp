#pragma once

#include <span>

namespace qddot {

// The least-squares line y = level + slope (x - middle). `middle` is the mean of x, `spread` the
// sum of (x - middle)^2, and `left` the sum of squared distances of y from the line.
struct StraightLine {
  double slope = 0, level = 0, middle = 0;
  double spread = 0, left = 0;
};

// Fits the line to as many x as y. The slope is zero if all x are equal.
StraightLine straight_line(std::span<const double> x, std::span<const double> y);

// The 97.5 % quantile of Student's t with `freedom` > 0 degrees of freedom, which is half the width
// of its 95 % interval.
double student_half_width(double freedom);

// y = c n^exponent, and the 95 % confidence interval of the exponent.
struct PowerLaw {
  double exponent, low, high;
};

// Fits a line to log y over log n by least squares, with Student's interval of its slope. The
// interval takes all deviations for noise. It does not allow for a law that bends, as at the edge
// of a cache. n and y are positive and of equal length. The exponent is NaN for fewer than two
// different n, the interval for fewer than three points.
PowerLaw fit_power_law(std::span<const double> n, std::span<const double> y);

}  // namespace qddot
