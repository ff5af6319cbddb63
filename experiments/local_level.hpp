#pragma once

#include "src/model/system.hpp"

namespace qddot {

// A number with its 95 % confidence interval.
struct Interval {
  double value = 0, low = 0, high = 0;

  bool holds(double x) const { return low <= x && x <= high; }
  bool excludes_zero() const { return !holds(0); }
};

// What a series y_1 ... y_n at equal distances says of the model
//   y_j = a + b j + w_j + n_j,
// n_j independent noise and w_j a random walk (a local level with a trend; Durbin and Koopman, Time
// Series Analysis by State Space Methods, 2.1 and 3.2). The interval of the slope b allows for
// both: it is narrow where the series only scatters and wide where it wanders, as a walk does by
// itself.
struct LocalLevel {
  Interval slope;       // b, a place
  double level = 0;     // a + b (n + 1)/2
  double walk = 0;      // standard deviation of the steps of w
  double noise = 0;     // and of n_j
  double evidence = 0;  // for a walk: 2 ln(its likelihood / that of none), >= 0
};

// The slope by generalised least squares, averaged over the ratios of walk to noise by their
// restricted likelihood; walk and noise at the likeliest. n >= 4.
LocalLevel fit_local_level(const Vec& y);

}  // namespace qddot
