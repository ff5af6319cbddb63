#pragma once

#include "qddot/model/system.hpp"

namespace qddot::measure {

// A number with its 95 % confidence interval.
struct Interval {
  double value = 0, low = 0, high = 0;

  bool holds(double x) const { return low <= x && x <= high; }
  bool excludes_zero() const { return !holds(0); }
};

// Which process beside a line and independent noise explains the means.
enum class Colour {
  none,        // none is needed
  oscillates,  // surely a stationary one: coloured noise, or a wave that was seen more than once
  turns,       // surely a wave, but little more than a period of it has been seen, or less
  undecided,   // a random walk, or coloured noise that cannot be told from one
};

// What the means y_1 ... y_n over blocks of equal length say of the model
//   y_j = a + b j + x_j + n_j,
// n_j independent noise and x a random walk or a stationary oscillation (coloured noise, or a wave
// that may forget its phase). See block_covariance.hpp, and Durbin and Koopman, Time Series
// Analysis by State Space Methods, 2.1 and 3.2. The interval of the slope b allows for x: it is
// narrow where the series only scatters or surely comes back, and wide where it may wander.
struct BlockFit {
  Interval slope{};  // b, a block
  double level = 0;  // a + b (n + 1)/2
  Colour colour = Colour::none;
  double walk = 0;    // standard deviation that x gains in a block, if it is a walk
  double noise = 0;   // and of n_j
  double period = 0;  // [blocks] of a wave, 0 where there is none
  double memory = 0;  // [blocks] coloured noise that forgets faster is excluded (95 %)
  // [blocks] Where the slope excludes zero: a sine of this period or a longer one, without a slope,
  // could be taken for that (95 %); at least n, infinite where none could.
  double slow_period = 0;
  // 2 ln of ratios of likelihoods: of a walk to noise alone, of coloured noise and a wave to a
  // walk.
  double walk_evidence = 0, noise_evidence = 0, wave_evidence = 0;
};

// By generalised least squares and restricted likelihood. The slope is averaged over the
// processes x that the colour leaves and their ratios to noise, by their likelihood. n >= 4.
BlockFit fit_blocks(const Vec& y);

}  // namespace qddot::measure
