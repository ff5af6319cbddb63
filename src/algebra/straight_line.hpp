#pragma once

#include <span>

namespace qddot {

// The straight line y = level + slope (x - middle) that leaves the least sum of squares, and the
// sums of squares that x spreads about its mean `middle` and that the line leaves of y.
struct StraightLine {
  double slope = 0, level = 0, middle = 0;
  double spread = 0, left = 0;
};

// x, y: as many of each. The slope is zero where all x are one.
StraightLine straight_line(std::span<const double> x, std::span<const double> y);

}  // namespace qddot
