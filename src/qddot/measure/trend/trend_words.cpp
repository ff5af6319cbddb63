#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/measure/trend/energy_trend.hpp"

namespace qddot::inline measure {
namespace {

std::string in_roundings(double value, const TrendScales& scales) {
  return scales.rounding > 0
             ? fmt::format(", {:.2g} roundings of the energy", value / scales.rounding)
             : "";
}

std::string drift_words(const Interval& drift) {
  return fmt::format("{:.3g}/s ({:.3g} to {:.3g})", drift.value, drift.low, drift.high);
}

std::string no_drift_words(const Interval& drift) {
  return fmt::format("no drift (|slope| < {:.1e}/s)",
                     std::max(std::abs(drift.low), std::abs(drift.high)));
}

std::string steady_words(const Trend& trend) {
  return trend.steady_from > 0 ? fmt::format(" from t = {:.3g} s on, after {:.1e} until then",
                                             trend.steady_from, trend.before)
                               : "";
}

std::string period_words(const Trend& trend) {
  return trend.colour == Colour::oscillates && trend.period > 0
             ? fmt::format(", with a slow wave of {:.3g} s", trend.period)
             : "";
}

// A sentence on a walk that is too small for the verdict, beneath the oscillation.
std::string beneath_words(const Trend& trend) {
  return trend.colour == Colour::undecided
             ? fmt::format(", beneath it at most a random walk of {:.1e} a root second", trend.walk)
             : "";
}

bool may_be_sine(const Trend& trend) {
  return trend.slow_period > 0 && std::isfinite(trend.slow_period);
}

// Describes what may be a drift, or a wave that has not been seen long enough.
std::string undecided_words(const Trend& trend) {
  std::string what;
  if (may_be_sine(trend)) {
    what = fmt::format("a drift, or an oscillation with a period of {:.2g} s or more",
                       trend.slow_period);
  } else if (trend.colour == Colour::turns) {
    what = fmt::format("an oscillation with a period of about {:.2g} s, or a change", trend.period);
  } else if (trend.colour == Colour::undecided) {
    what = fmt::format(
        "it wanders by {:.1e} in a second and with the root of the time, unless it returns after "
        "{:.2g} s or more",
        trend.walk, trend.memory);
  } else {
    what = "an oscillation that widens, or beats slowly";
  }
  return fmt::format("too short to tell: run it to t = {:.1g} s; so far {}; oscillates by {:.1e}, ",
                     trend.needed, what, trend.oscillation) +
         (may_be_sine(trend) ? "slope " + drift_words(trend.drift) : no_drift_words(trend.drift));
}

// A sentence if the drift of the second half surely differs.
std::string change_words(const Trend& trend) {
  if (trend.late_drift.holds(trend.drift.value)) return "";
  const bool is_less = std::abs(trend.late_drift.value) < std::abs(trend.drift.value);
  return fmt::format(", {} ({:.2g}/s in the second half)", is_less ? "slows down" : "speeds up",
                     trend.late_drift.value);
}

}  // namespace

std::string trend_in_words(const Trend& trend, const TrendScales& scales) {
  switch (trend.verdict) {
    case Verdict::bounded:
      return fmt::format("bounded: oscillates by {:.1e}{}{}, {}{}", trend.oscillation,
                         period_words(trend), beneath_words(trend), no_drift_words(trend.drift),
                         steady_words(trend));
    case Verdict::undecided:
      return undecided_words(trend) + steady_words(trend);
    case Verdict::widens:
      return fmt::format(
          "widens: its oscillation of {:.1e} grows by {:.2g} of that a second ({:.2g} to {:.2g}), "
          "{}{}",
          trend.oscillation, trend.widening.value, trend.widening.low, trend.widening.high,
          no_drift_words(trend.drift), steady_words(trend));
    case Verdict::round_off: {
      const double root_step = trend.walk * std::sqrt(scales.step);
      if (trend.drift.excludes_zero()) {
        return fmt::format("only round-off, which adds up: drifts by {}{} a step",
                           drift_words(trend.drift),
                           in_roundings(trend.drift.value * scales.step, scales));
      }
      return root_step > 0
                 ? fmt::format("only round-off: random walk of {:.1e} a root step{}, {}", root_step,
                               in_roundings(root_step, scales), no_drift_words(trend.drift))
                 : fmt::format("only round-off: stays within {:.1e}, {}", trend.oscillation,
                               no_drift_words(trend.drift));
    }
    case Verdict::drifts:
      return fmt::format("drifts by {}{}, oscillates by {:.1e}{}", drift_words(trend.drift),
                         steady_words(trend), trend.oscillation, change_words(trend));
    case Verdict::dissipates:
      return fmt::format(
          "dissipates like a damping ratio of {:.2g} (energy falls at {:.3g}/s, by {:.2g} of its "
          "excess)",
          trend.damping_ratio, -trend.rate.value, -trend.last_error / scales.excess);
    case Verdict::grows:
      return fmt::format("grows at {:.3g}/s ({:.3g} to {:.3g}), by {:.2g} of its excess",
                         trend.rate.value, trend.rate.low, trend.rate.high,
                         trend.last_error / scales.excess);
    case Verdict::blows_up:
      return trend.rate.value > 0
                 ? fmt::format("grows: blows up at t = {:.4g} s (rate {:.3g}/s)",
                               trend.blow_up_time, trend.rate.value)
                 : fmt::format("grows: blows up at t = {:.4g} s, at once", trend.blow_up_time);
    case Verdict::unknown:
      break;
  }
  return "too short for a verdict";
}

}  // namespace qddot::inline measure
