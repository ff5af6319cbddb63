#pragma once

#include "qddot/model/system.hpp"

namespace qddot::inline measure {

// A number with its 95 % confidence interval.
struct Interval {
  double value = 0, low = 0, high = 0;

  bool holds(double x) const { return low <= x && x <= high; }
  bool excludes_zero() const { return !holds(0); }
};

// The process that explains the means, beside a line and independent noise.
enum class Colour {
  none,        // none is needed
  oscillates,  // surely stationary: coloured noise, or a wave seen for more than a period
  turns,       // surely a wave, but seen for little more than one period or less
  undecided,   // a random walk, or coloured noise that cannot be told from a walk
};

// The fit of a model to means y_1 ... y_n over blocks of equal length:
//   y_j = a + b j + x_j + n_j,
// n_j is independent noise. x is a random walk or a stationary oscillation: coloured noise, or a
// wave that may forget its phase. See block_covariance.hpp, and Durbin and Koopman, Time Series
// Analysis by State Space Methods, 2.1 and 3.2. The interval of the slope b allows for x: it is
// narrow if the series only scatters or surely returns, and wide if it may wander.
struct BlockFit {
  Interval slope{};  // b, per block
  double level = 0;  // a + b (n + 1)/2
  Colour colour = Colour::none;
  double walk = 0;    // standard deviation that x gains per block, if it is a walk
  double noise = 0;   // standard deviation of n_j
  double period = 0;  // [blocks] of a wave, 0 if there is none
  double memory = 0;  // [blocks] shorter memories of coloured noise are excluded (95 %)
  // [blocks] If the slope excludes zero: the least period of a sine, without a slope, that could
  // look like this slope (95 %). It is n or more; infinite if no sine could.
  double slow_period = 0;
  // 2 ln of ratios of likelihoods: a walk over noise alone, coloured noise over a walk, a wave over
  // a walk.
  double walk_evidence = 0, noise_evidence = 0, wave_evidence = 0;
};

// Fits the model to y_1 ... y_n, n >= 4, by generalised least squares and restricted likelihood.
// The slope is the average, weighted by likelihood, over the processes x that the colour allows and
// over their ratios to noise.
BlockFit fit_blocks(const Vec& y);

}  // namespace qddot::inline measure
