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

}  // namespace qddot
