#pragma once

#include <span>
#include <string>

#include "qddot/integrators/integrator.hpp"
#include "qddot/measure/trend/block_fit.hpp"
#include "qddot/measure/trend/block_means.hpp"

namespace qddot::measure {

// What the errors of a run are judged against.
struct TrendScales {
  double excess = 1;     // of the energy over that at rest at t = 0, in units of the error
  double frequency = 1;  // [rad/s], of which a loss is given as a damping ratio
  double rounding = 0;   // what one rounding of the energy is, in units of the error
  double step = 0;       // the mean length of a step [s]
};

enum class Verdict {
  bounded,     // no drift, and an oscillation about one level that surely comes back
  round_off,   // nothing but rounding: a random walk, sqrt(t) (Brouwer's law), or less; or a drift
               // of less than one rounding of the energy a step
  undecided,   // too short to tell a drift or a random walk from a slow oscillation
  widens,      // no drift, but an oscillation that grows
  drifts,      // the interval of the slope excludes zero, and a sine of two runs' length
  dissipates,  // more than a tenth of the excess energy goes, exponentially
  grows,       // likewise more than a tenth comes, but no more than `blown_up`
  blows_up,    // the error exceeds `blown_up`
  unknown,     // too few samples, or too little of the run
};
constexpr const char* verdict_name(Verdict verdict) {
  constexpr const char* names[] = {"bounded",    "round_off", "undecided", "widens", "drifts",
                                   "dissipates", "grows",     "blows_up",  "unknown"};
  return names[static_cast<int>(verdict)];
}
constexpr double blown_up = 10;

// The errors e(t) of a run taken apart. With blocks of equal duration and their means m_j:
//   m_j = level + drift t_j + (random walk or slow oscillation) + noise          (BlockFit),
//   e = level + drift t + oscillation.
// Where the last half or quarter of the run is level or straight and the rest is not, the error has
// settled: its trend is that of this last part.
// Or where the excess x = 1 + e/excess falls or rises by more than a tenth:
//   x = e^(rate t), which loses energy as a damping ratio zeta = -rate/(2 frequency) does.
struct Trend {
  Verdict verdict = Verdict::unknown;
  // [1/s]; of what falls or rises exponentially the slope with which that begins, excess rate.
  Interval drift;
  double steady_from = 0;  // [s] from here on, 0 where the trend is that of the whole run
  double before = 0;       // where that trend begins, where steady_from > 0
  // [1/s], over the second half of the run; differs from `drift` where that changes.
  Interval late_drift;
  double oscillation = 0;  // half of what 95 % of the errors span about the trend
  double walk = 0;         // of the error in one second [1/sqrt(s)]; 0 where there is no evidence
  Colour colour = Colour::none;
  double period = 0;  // [s] of a slow wave, 0 where there is none
  double memory = 0;  // [s] coloured noise that forgets faster is excluded, if undecided
  // [s] A sine of this period or a longer one could be taken for the drift; infinite if none.
  double slow_period = 0;
  Interval widening;  // [1/s] growth of the oscillation, of its mean size
  double needed = 0;  // [s] the length of a run that would tell, if undecided
  Interval rate;      // [1/s] of the exponential, zero where there is none
  double damping_ratio = 0;
  double blow_up_time = 0;  // [s], when the error first exceeded `blown_up`
  double last_error = 0;    // the mean over the last block
};

// The trend of samples in the order of time from t = 0 on (which itself is none), of a run that
// ended so.
Trend trend_of(std::span<const Sample> samples, Outcome outcome, const TrendScales& scales);

// The same of what can neither fall nor rise exponentially: no exponentials, no blow-up.
Trend line_of(std::span<const Sample> samples, const TrendScales& scales);

// The trend in words; "no drift" only where the interval of the slope holds zero.
std::string trend_in_words(const Trend& trend, const TrendScales& scales);

}  // namespace qddot::measure
