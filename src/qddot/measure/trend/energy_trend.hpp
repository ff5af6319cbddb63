#pragma once

#include <span>
#include <string>

#include "qddot/integrators/integrator.hpp"
#include "qddot/measure/trend/block_fit.hpp"
#include "qddot/measure/trend/block_means.hpp"

namespace qddot::inline measure {

// Scales for the errors of a run.
struct TrendScales {
  double excess = 1;     // energy at t = 0 minus that at rest, in units of the error
  double frequency = 1;  // [rad/s], for the damping ratio of a loss
  double rounding = 0;   // one rounding of the energy, in units of the error
  double step = 0;       // the mean length of a step [s]
};

// A trend in one word.
enum class Verdict {
  bounded,     // no drift; an oscillation about one level that surely returns
  round_off,   // nothing but rounding: a random walk, sqrt(t) (Brouwer's law), or less; or a drift
               // of less than one rounding of the energy a step
  undecided,   // too short to tell a drift or a random walk from a slow oscillation
  widens,      // no drift, but an oscillation that grows
  drifts,      // the interval of the slope excludes zero, and a sine of two runs' length
  dissipates,  // more than a tenth of the excess energy is lost, exponentially
  grows,       // more than a tenth is gained, but no more than `blown_up`
  blows_up,    // the error exceeds `blown_up`
  unknown,     // too few samples, or too little of the run
};
constexpr const char* verdict_name(Verdict verdict) {
  constexpr const char* names[] = {"bounded",    "round_off", "undecided", "widens", "drifts",
                                   "dissipates", "grows",     "blows_up",  "unknown"};
  return names[static_cast<int>(verdict)];
}
constexpr double blown_up = 10;

// The trend of the errors e(t) of a run. m_j are means over blocks of equal duration:
//   m_j = level + drift t_j + (random walk or slow oscillation) + noise          (BlockFit),
//   e = level + drift t + oscillation.
// An error has settled if the last half or quarter of the run is level or straight and the rest is
// not; its trend is that of this last part. The model is exponential if the excess x = 1 + e/excess
// falls or rises by more than a tenth:
//   x = exp(rate t), as with a damping ratio zeta = -rate/(2 frequency).
struct Trend {
  Verdict verdict = Verdict::unknown;
  // [1/s]; the slope at the start, excess * rate, if the trend is exponential.
  Interval drift;
  double steady_from = 0;  // [s] start of that last part, 0 if the whole run counts
  double before = 0;       // the trend's value at steady_from, if that is > 0
  // [1/s], over the second half of the run; differs from `drift` if the drift changes.
  Interval late_drift;
  double oscillation = 0;  // half the span of 95 % of the errors about the trend
  double walk = 0;         // random walk of the error [1/sqrt(s)]; 0 without evidence
  Colour colour = Colour::none;
  double period = 0;  // [s] of a slow wave, 0 if there is none
  double memory = 0;  // [s] shorter memories of noise are excluded, if undecided
  // [s] The least period of a sine that could look like the drift; infinite if there is none.
  double slow_period = 0;
  Interval widening;  // [1/s] growth of the oscillation over its mean size
  double needed = 0;  // [s] length of a run that could decide, if undecided
  Interval rate;      // [1/s] of the exponential, zero if there is none
  double damping_ratio = 0;
  double blow_up_time = 0;  // [s], time at which the error first exceeded `blown_up`
  double last_error = 0;    // the mean over the last block
};

// The trend of samples of a run with that outcome. Samples ascend in time and begin after t = 0.
Trend trend_of(std::span<const Sample> samples, Outcome outcome, const TrendScales& scales);

// The same for invariants that cannot fall or rise exponentially: no exponentials, no blow-up.
Trend line_of(std::span<const Sample> samples, const TrendScales& scales);

// The trend in words; "no drift" only if the interval of the slope contains zero.
std::string trend_in_words(const Trend& trend, const TrendScales& scales);

}  // namespace qddot::inline measure
