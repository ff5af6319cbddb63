#include "qddot/measure/trend/energy_trend.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "qddot/algebra/straight_line.hpp"

namespace qddot::inline measure {
namespace {

// The least number of block means. Fewer do not show whether the error wanders.
constexpr Index told_blocks = 16;
// The trend of the last part of a run replaces that of the whole if its uncertainty is smaller by
// this factor. For a line through noise, the last part is nearly three times less certain; for a
// walk, nearly as certain.
constexpr double much_surer = 0.25;
// A drift, or its end, must differ from part of a sine with a period of up to this many run
// lengths.
constexpr double slow_runs = 2;
// Such a sine moves by more than `range` times its range in the part of the run after `begin`, in
// means over eighths of the part. About its crest it moves by 1 - cos(7/8 pi/4) of its amplitude in
// half of the run. In a quarter of it, it moves by 1 - cos(7/8 pi/8).
struct LastPart {
  double begin, range;
};
// A faster sine moves as much in the last part as before. A steady part moves by less than this
// fraction.
constexpr double quieter = 0.5;
constexpr LastPart last_parts[] = {{0.5, 0.11}, {0.75, 0.029}};
// A walk or slow wave can be seen beneath an oscillation ten times as large. The words then mention
// it; the verdict follows the oscillation.
constexpr double beneath = 0.1;
// An oscillation widens if it grows by at least this fraction of its mean size.
constexpr double widening_part = 0.1;
// A run of this many memories nearly always tells coloured noise from a walk, and a run of two
// periods tells a wave from a drift. A new run is longer by at least `longer`.
constexpr double memories_needed = 60, periods_needed = 2, longer = 4;
// A loss or gain of less than this part of the excess energy is called a drift.
constexpr double exponential_part = 0.1;
// A loss is fitted until this fraction of the excess is left: only slow modes remain then. Less
// than `tiny` counts as zero. An excess that returns to half was no loss.
constexpr double nearly_gone = 0.1, tiny = 1e-3, half_back = 0.5;
// A blow-up that has no one rate from the start on is fitted between these excesses: the growing
// energy is far larger than the energy before. If there are too few samples, the rate is that since
// the excess was last below `doubled`.
constexpr double growing = 100, grown = 1e8, doubled = 2;
// The excess grows by one rate if ln x is within this of a line until the blow-up. If only the part
// a of it grows, x = 1 - a + a exp(rate t), it is while a > 0.9, where the line's rate is 4 % less.
constexpr double steady = 0.02;
// The roundings of the energy in one evaluation and in one step; both sum over many springs.
constexpr double roundings_of_energy = 100, roundings_of_step = 10;

Interval scaled(const Interval& x, double factor) {
  return {factor * x.value, factor * x.low, factor * x.high};
}

// ln x = level + rate (t - middle).
struct Exponential {
  Interval rate;
  double level = 0, middle = 0, slow_period = 0;
  double range = 0, slow = 0;  // of the means of ln x, and of means over eighths of the blocks
};

Exponential fit_exponential(Blocks x) {
  if (x.count() == 0 || (x.means.array() <= 0).any()) return {};
  x.means = x.means.array().log();
  const BlockFit fit = fit_blocks(x.means);
  return {
      scaled(fit.slope, 1 / x.length),         fit.level,    x.middle(), fit.slow_period * x.length,
      x.means.maxCoeff() - x.means.minCoeff(), slow_range(x)};
}

// Half the width of the middle 95 % of weighted numbers.
double half_span(std::vector<std::pair<double, double>> weighted) {
  std::ranges::sort(weighted);
  double all = 0;
  for (const auto& [value, weight] : weighted) all += weight;
  double low = weighted.front().first, high = weighted.back().first, sum = 0;
  for (const auto& [value, weight] : weighted) {
    if (sum <= 0.025 * all) low = value;
    if (sum <= 0.975 * all) high = value;
    sum += weight;
  }
  return (high - low) / 2;
}

template <class Expected>
double oscillation_about(std::span<const Sample> samples, const Expected& expected) {
  std::vector<std::pair<double, double>> deviations;
  for (const Sample& s : samples) deviations.emplace_back(s.error - expected(s.t), s.weight);
  return deviations.empty() ? 0 : half_span(std::move(deviations));
}

std::span<const Sample> after(std::span<const Sample> samples, double t) {
  return {std::ranges::find_if(samples, [&](const Sample& sample) { return sample.t > t; }),
          samples.end()};
}

// The fit of an exponential to the excess energy x = 1 + e/excess.
class Excess {
 public:
  Excess(std::span<const Sample> samples, const TrendScales& scales)
      : samples_(samples), scales_(scales) {}

  double of(const Sample& sample) const { return 1 + sample.error / scales_.excess; }

  // Fits a loss, or a gain that does not end.
  void fit_slow(Trend& trend) const {
    const auto end = std::ranges::find_if(
        samples_, [&](const Sample& sample) { return of(sample) < nearly_gone; });
    // An excess that returns is a large oscillation, not a loss.
    if (std::any_of(end, samples_.end(), [&](const Sample& s) { return of(s) > half_back; }))
      return;
    const std::span<const Sample> window(samples_.begin(), end);
    const bool is_gone = end != samples_.end();
    const Exponential fit = take(trend, window, 0);
    if (!is_gone && (has_ended(window, fit) || is_slow_sine(window, fit))) trend.rate = {};
    if (is_gone && !trend.rate.excludes_zero()) {
      take_alone(trend, std::log(std::clamp(of(*end), tiny, nearly_gone)) / end->t);
    }
  }

  // Fits the growth of a run that blew up. Where all of the energy grows from the start on, the fit
  // is until then: beyond it, the motion is another one, whose rate may differ.
  void fit_blow_up(Trend& trend) const {
    const auto end = std::ranges::find_if(
        samples_, [&](const Sample& sample) { return sample.t > trend.blow_up_time; });
    if (grows_steadily({samples_.begin(), end}, trend)) return;
    const auto too_large =
        std::ranges::find_if(samples_, [&](const Sample& sample) { return of(sample) > grown; });
    if (const auto rise = last_rise(growing, too_large); !rise.empty()) {
      take(trend, rise, rise.front().t);
      if (trend.rate.value != 0) return;
    }
    const auto rise = last_rise(doubled, too_large);
    if (rise.size() < 2) return;
    take_alone(trend,
               std::log(of(rise.back()) / of(rise.front())) / (rise.back().t - rise.front().t));
  }

 private:
  Exponential fit(std::span<const Sample> window, double begin) const {
    return fit_exponential(in_blocks(window, begin, [&](const Sample& s) { return of(s); }));
  }

  // The samples before `end` since the excess was last below `from`.
  std::span<const Sample> last_rise(double from, std::span<const Sample>::iterator end) const {
    auto begin = end;
    while (begin != samples_.begin() && of(*(begin - 1)) > from) --begin;
    return {begin, end};
  }

  // Whether the whole excess grows by one rate in the window; takes that rate.
  bool grows_steadily(std::span<const Sample> window, Trend& trend) const {
    const Exponential fit = this->fit(window, 0);
    if (!(fit.rate.low > 0)) return false;
    const auto error = [&](const Sample& s) {
      return std::abs(std::log(of(s)) - fit.level - fit.rate.value * (s.t - fit.middle));
    };
    if (std::ranges::any_of(window, [&](const Sample& s) { return !(error(s) < steady); })) {
      return false;
    }
    take(trend, window, 0);
    // Means of an exponential over blocks are a little above it; the samples themselves are not.
    std::vector<double> t, logarithm;
    for (const Sample& s : window) {
      t.push_back(s.t);
      logarithm.push_back(std::log(of(s)));
    }
    const double moved = straight_line(t, logarithm).slope - trend.rate.value;
    for (double* bound : {&trend.rate.value, &trend.rate.low, &trend.rate.high}) *bound += moved;
    trend.drift = scaled(trend.rate, scales_.excess);
    return true;
  }

  // Whether the fall or rise is over: the last part of the window is level.
  bool has_ended(std::span<const Sample> window, const Exponential& whole) const {
    return std::ranges::any_of(last_parts, [&](const LastPart& part) {
      const double begin = part.begin * window.back().t;
      const Exponential last = fit(after(window, begin), begin);
      return last.rate.holds(0) && !last.rate.holds(whole.rate.value) &&
             last.slow < part.range * whole.range && last.range < quieter * whole.range;
    });
  }

  // Whether the trend may be part of a slow sine. A sine does not lose most of the excess.
  bool is_slow_sine(std::span<const Sample> window, const Exponential& fit) const {
    return fit.slow_period < slow_runs * window.back().t && of(window.back()) > half_back;
  }

  // Takes a rate from too few samples for a fit; its interval is unknown.
  void take_alone(Trend& trend, double rate) const {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    trend.rate = {rate, unknown, unknown};
    trend.drift = scaled(trend.rate, scales_.excess);
  }

  Exponential take(Trend& trend, std::span<const Sample> window, double begin) const {
    const Exponential fit = this->fit(window, begin);
    trend.rate = fit.rate;
    trend.drift = scaled(fit.rate, scales_.excess);
    trend.oscillation = oscillation_about(window, [&](double t) {
      return scales_.excess * std::expm1(fit.level + fit.rate.value * (t - fit.middle));
    });
    return fit;
  }

  std::span<const Sample> samples_;
  const TrendScales& scales_;
};

// Whether the trend may be rounding of the energy alone. Roundings oscillate or walk with the
// square root of the number of steps. If all have one sign, they drift with that number.
bool is_rounding(const Trend& trend, double largest_mean, double steps, const TrendScales& s) {
  const double walked = (roundings_of_energy + roundings_of_step * std::sqrt(steps)) * s.rounding;
  if (trend.oscillation > walked) return false;
  return trend.drift.excludes_zero() ? std::abs(trend.drift.value) * s.step <= s.rounding
                                     : largest_mean <= walked;
}

// The line through samples from `begin` on.
struct Line {
  double begin = 0;
  Interval drift;
  BlockFit fit{};
  double length = 0;  // of a block [s]
  double walk = 0, oscillation = 0, largest_mean = 0;
  double range = 0, slow = 0;  // of the means, and of means over eighths of the blocks
  double start = 0;            // its value at `begin`
  Interval widening{};
  double widening_period = 0;  // [s] as BlockFit::slow_period, of the slope of the widening

  double uncertainty() const { return drift.high - drift.low; }
  double slow_period() const { return fit.slow_period * length; }
};

std::optional<Line> line_through(std::span<const Sample> samples, double begin) {
  const Blocks blocks = in_blocks(samples, begin, [](const Sample& s) { return s.error; });
  if (blocks.count() < told_blocks) return {};
  const BlockFit fit = fit_blocks(blocks.means);
  Line line{.begin = begin,
            .drift = scaled(fit.slope, 1 / blocks.length),
            .fit = fit,
            .length = blocks.length,
            .largest_mean = blocks.means.lpNorm<Eigen::Infinity>(),
            .range = blocks.means.maxCoeff() - blocks.means.minCoeff(),
            .slow = slow_range(blocks)};
  const auto expected = [&](double t) {
    return fit.level + line.drift.value * (t - blocks.middle());
  };
  line.start = expected(begin);
  line.oscillation = oscillation_about(samples, expected);
  if (fit.colour != Colour::none) line.walk = fit.walk / std::sqrt(blocks.length);
  return line;
}

// Fits the growth of the root mean square about the line, from block to block.
void fit_widening(Line& line, std::span<const Sample> samples) {
  Blocks squares = in_blocks(samples, line.begin, [&](const Sample& s) {
    const double deviation = s.error - line.start - line.drift.value * (s.t - line.begin);
    return deviation * deviation;
  });
  squares.means = squares.means.array().sqrt();
  const double size = squares.means.mean();
  if (!(size > 0)) return;
  const BlockFit fit = fit_blocks(squares.means);
  line.widening = scaled(fit.slope, 1 / (squares.length * size));
  line.widening_period = fit.slow_period * squares.length;
}

// The last part of the run, if the run was different before.
std::optional<Line> steady_line(std::span<const Sample> samples, const Line& whole) {
  const double duration = samples.back().t;
  for (const LastPart& part : last_parts) {
    const double begin = part.begin * duration;
    const std::optional<Line> last = line_through(after(samples, begin), begin);
    if (!last || last->slow > part.range * whole.range) continue;
    if (last->range > quieter * whole.range) continue;
    const bool is_level = !last->drift.excludes_zero() && last->fit.colour != Colour::turns &&
                          last->fit.colour != Colour::undecided;
    const bool has_stopped =
        is_level && whole.drift.excludes_zero() && !last->drift.holds(whole.drift.value);
    if (has_stopped || last->uncertainty() < much_surer * whole.uncertainty()) return last;
  }
  return {};
}

// The slope. Its interval contains zero if a slow sine may explain it.
Interval cautious_drift(const Line& line, double duration) {
  const Interval& d = line.drift;
  const bool may_be_sine = d.excludes_zero() && line.slow_period() < slow_runs * duration;
  if (!may_be_sine) return d;
  return {d.value, std::min(d.low, 0.0), std::max(d.high, 0.0)};
}

// Whether the line leaves something undecided; sets the length of a run that could decide.
bool is_undecided(Trend& trend, const Line& line, double duration) {
  const bool is_seen = trend.walk * std::sqrt(duration) > beneath * trend.oscillation;
  const bool may_be_sine = line.drift.excludes_zero() && trend.slow_period < slow_runs * duration;
  const bool may_beat = trend.widening.low * duration > 0 &&
                        trend.widening.value * duration > widening_part &&
                        line.widening_period < slow_runs * duration;
  const bool turns = trend.colour == Colour::turns && is_seen && !line.drift.excludes_zero();
  const bool may_walk = trend.colour == Colour::undecided && is_seen && !line.drift.excludes_zero();
  if (!may_be_sine && !may_beat && !turns && !may_walk) return false;
  trend.needed = longer * duration;
  if (may_be_sine) trend.needed = std::max(trend.needed, periods_needed * trend.slow_period);
  if (may_beat) trend.needed = std::max(trend.needed, periods_needed * line.widening_period);
  if (turns) trend.needed = std::max(trend.needed, periods_needed * trend.period);
  if (may_walk) trend.needed = std::max(trend.needed, memories_needed * trend.memory);
  return true;
}

void take_line(Trend& trend, std::span<const Sample> samples, const TrendScales& scales) {
  std::optional<Line> line = line_through(samples, 0);
  if (!line) return;
  const double duration = samples.back().t, half = duration / 2;
  const auto second = line_through(after(samples, half), half);
  trend.late_drift = cautious_drift(second ? *second : *line, duration);
  const double largest_mean = line->largest_mean;
  if (const auto last = steady_line(samples, *line)) {
    line = last;
    trend.steady_from = line->begin;
    trend.before = line->start;
  }
  fit_widening(*line, after(samples, line->begin));
  trend.drift = cautious_drift(*line, duration);
  trend.walk = line->walk;
  trend.oscillation = line->oscillation;
  trend.colour = line->fit.colour;
  trend.period = line->fit.period * line->length;
  trend.memory = line->fit.memory * line->length;
  trend.slow_period = line->slow_period();
  trend.widening = line->widening;
  const double steps = scales.step > 0 ? duration / scales.step : 1;
  if (is_rounding(trend, largest_mean, steps, scales)) {
    trend.verdict = Verdict::round_off;
  } else if (is_undecided(trend, *line, duration)) {
    trend.verdict = Verdict::undecided;
  } else if (trend.drift.excludes_zero()) {
    trend.verdict = Verdict::drifts;
  } else if (trend.widening.low > 0 && trend.widening.value * duration > widening_part) {
    trend.verdict = Verdict::widens;
  } else {
    trend.verdict = Verdict::bounded;
  }
}

}  // namespace

Trend trend_of(std::span<const Sample> samples, Outcome outcome, const TrendScales& scales) {
  Trend trend;
  const auto error = [](const Sample& sample) { return sample.error; };
  const auto high =
      std::ranges::find_if(samples, [](const Sample& s) { return s.error > blown_up; });
  const Excess excess(samples, scales);
  if (high != samples.end() ||
      (!samples.empty() && (outcome == Outcome::diverged || outcome == Outcome::not_finite))) {
    trend.verdict = Verdict::blows_up;
    trend.last_error = samples.back().error;
    trend.blow_up_time = high != samples.end() ? high->t : samples.back().t;
    excess.fit_blow_up(trend);
    return trend;
  }
  const Blocks blocks = in_blocks(samples, 0, error);
  if (blocks.means.size() == 0) return trend;
  trend.last_error = blocks.means[blocks.means.size() - 1];
  if (std::abs(trend.last_error) > exponential_part * scales.excess) {
    excess.fit_slow(trend);
    if (trend.last_error * trend.rate.value > 0 && trend.rate.excludes_zero()) {
      trend.verdict = trend.last_error > 0 ? Verdict::grows : Verdict::dissipates;
      if (scales.frequency > 0) trend.damping_ratio = -trend.rate.value / (2 * scales.frequency);
      return trend;
    }
    trend.rate = {};
  }
  take_line(trend, samples, scales);
  return trend;
}

Trend line_of(std::span<const Sample> samples, const TrendScales& scales) {
  Trend trend;
  const Blocks blocks = in_blocks(samples, 0, [](const Sample& sample) { return sample.error; });
  if (blocks.means.size() == 0) return trend;
  trend.last_error = blocks.means[blocks.means.size() - 1];
  take_line(trend, samples, scales);
  return trend;
}

}  // namespace qddot::inline measure
