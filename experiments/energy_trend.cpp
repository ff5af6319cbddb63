#include "experiments/energy_trend.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace qddot {
namespace {

constexpr Index most_blocks = 64, least_blocks = 4;
// For each block at least so many samples, of which the mean is taken, unless there are too few.
constexpr std::ptrdiff_t samples_a_block = 4;
// Of a run that first does something else, the second half says so much more surely what it comes
// to; of one line through noise it says nearly three times less, of a walk nearly the same.
constexpr double much_surer = 0.25;
// Less than this part of the excess energy lost or won is called a drift.
constexpr double exponential_part = 0.1;
// A loss is fitted until so much of the excess is left: then the slow modes remain. Less than
// `tiny` is not told from nothing, and what comes back to half was no loss.
constexpr double nearly_gone = 0.1, tiny = 1e-3, half_back = 0.5;
// And a blow-up from here on, where what grows is far more than what was there, up to here.
constexpr double growing = 100, grown = 1e8;
// 2 ln of the ratio of likelihoods that chance exceeds once in a hundred times, the variance of the
// walk being at the edge of what is possible (Self and Liang, J. American Statistical Association
// 82 (1987) 605-610).
constexpr double certain_walk = 5.4;
// Roundings of the energy that one evaluation of it and one step may make: sums over many springs.
constexpr double roundings_of_energy = 100, roundings_of_step = 10;

// Means over blocks of equal duration, none of them empty.
struct Blocks {
  Vec means;                     // empty where there are too few samples
  double begin = 0, length = 0;  // [s]
};

template <class Value>
Blocks in_blocks(std::span<const Sample> samples, double begin, const Value& value) {
  if (samples.empty()) return {};
  const double end = samples.back().t;
  const Index all = std::ssize(samples);
  Index count = std::clamp(all / samples_a_block, std::min(all, least_blocks), most_blocks);
  for (; count >= least_blocks; count /= 2) {
    Blocks blocks{Vec::Zero(count), begin, (end - begin) / static_cast<double>(count)};
    Vec weights = Vec::Zero(count);
    for (const Sample& sample : samples) {
      const auto block =
          std::clamp<Index>(static_cast<Index>((sample.t - begin) / blocks.length), 0, count - 1);
      blocks.means[block] += sample.weight * value(sample);
      weights[block] += sample.weight;
    }
    if ((weights.array() <= 0).any()) continue;
    blocks.means.array() /= weights.array();
    return blocks;
  }
  return {};
}

Interval scaled(const Interval& x, double factor) {
  return {factor * x.value, factor * x.low, factor * x.high};
}

// ln x = level + rate (t - middle).
struct Exponential {
  Interval rate;
  double level = 0, middle = 0;
};

Exponential fit_exponential(const Blocks& x) {
  if (x.means.size() == 0 || (x.means.array() <= 0).any()) return {};
  const LocalLevel fit = fit_local_level(x.means.array().log());
  const auto half = static_cast<double>(x.means.size()) / 2;
  return {scaled(fit.slope, 1 / x.length), fit.level, x.begin + half * x.length};
}

// Half of what the middle 95 % of weighted numbers span.
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

// The samples of a trend that is exponential, and what they say.
class Excess {
 public:
  Excess(std::span<const Sample> samples, const TrendScales& scales)
      : samples_(samples), scales_(scales) {}

  double of(const Sample& sample) const { return 1 + sample.error / scales_.excess; }

  // Of what is lost, or won without end in sight.
  void fit_slow(Trend& trend) const {
    const auto end = std::ranges::find_if(
        samples_, [&](const Sample& sample) { return of(sample) < nearly_gone; });
    // An oscillation that is so large comes back.
    if (std::any_of(end, samples_.end(), [&](const Sample& s) { return of(s) > half_back; }))
      return;
    take(trend, {samples_.begin(), end}, 0);
    if (trend.rate.value != 0 || end == samples_.end()) return;
    // Too few for a fit.
    const double rate = std::log(std::clamp(of(*end), tiny, nearly_gone)) / end->t;
    trend.rate = {rate, rate, rate};
    trend.drift = scaled(trend.rate, scales_.excess);
  }

  void fit_blow_up(Trend& trend) const {
    const auto end =
        std::ranges::find_if(samples_, [&](const Sample& sample) { return of(sample) > grown; });
    auto begin = end;
    while (begin != samples_.begin() && of(*(begin - 1)) > growing) --begin;
    const std::span<const Sample> rise(begin, end);
    if (rise.empty()) return;
    take(trend, rise, rise.front().t);
    if (trend.rate.value != 0 || rise.size() < 2) return;
    // Too few for a fit.
    const double rate =
        std::log(of(rise.back()) / of(rise.front())) / (rise.back().t - rise.front().t);
    trend.rate = {rate, rate, rate};
    trend.drift = scaled(trend.rate, scales_.excess);
  }

 private:
  void take(Trend& trend, std::span<const Sample> window, double begin) const {
    const Exponential fit =
        fit_exponential(in_blocks(window, begin, [&](const Sample& s) { return of(s); }));
    trend.rate = fit.rate;
    trend.drift = scaled(fit.rate, scales_.excess);
    trend.oscillation = oscillation_about(window, [&](double t) {
      return scales_.excess * std::expm1(fit.level + fit.rate.value * (t - fit.middle));
    });
  }

  std::span<const Sample> samples_;
  const TrendScales& scales_;
};

// Whether that is no more than rounding makes of energies in a run: what oscillates, and what walks
// with the root of the steps or, where all roundings go one way, drifts with their number.
bool is_rounding(const Trend& trend, double largest_mean, double steps, const TrendScales& s) {
  const double walked = (roundings_of_energy + roundings_of_step * std::sqrt(steps)) * s.rounding;
  if (trend.oscillation > walked) return false;
  return trend.drift.excludes_zero() ? std::abs(trend.drift.value) * s.step <= s.rounding
                                     : largest_mean <= walked;
}

// The line through samples from `begin` on.
struct Line {
  Interval drift;
  double walk = 0, oscillation = 0, largest_mean = 0;
  double start = 0;  // its value at `begin`

  double uncertainty() const { return drift.high - drift.low; }
};

std::optional<Line> line_through(std::span<const Sample> samples, double begin) {
  const Blocks blocks = in_blocks(samples, begin, [](const Sample& s) { return s.error; });
  if (blocks.means.size() == 0) return {};
  const LocalLevel fit = fit_local_level(blocks.means);
  Line line{.drift = scaled(fit.slope, 1 / blocks.length),
            .largest_mean = blocks.means.lpNorm<Eigen::Infinity>()};
  const double middle = begin + static_cast<double>(blocks.means.size()) / 2 * blocks.length;
  line.start = fit.level + line.drift.value * (begin - middle);
  line.oscillation = oscillation_about(
      samples, [&](double t) { return fit.level + line.drift.value * (t - middle); });
  if (fit.evidence > certain_walk) line.walk = fit.walk / std::sqrt(blocks.length);
  return line;
}

void take_line(Trend& trend, std::span<const Sample> samples, const TrendScales& scales) {
  std::optional<Line> line = line_through(samples, 0);
  if (!line) return;
  const double duration = samples.back().t, half = duration / 2;
  const auto late =
      std::ranges::find_if(samples, [&](const Sample& sample) { return sample.t > half; });
  const auto second = line_through({late, samples.end()}, half);
  trend.late_drift = second ? second->drift : line->drift;
  const bool has_stopped = line->drift.excludes_zero() && trend.late_drift.holds(0) &&
                           !trend.late_drift.holds(line->drift.value);
  trend.has_settled =
      second && (has_stopped || second->uncertainty() < much_surer * line->uncertainty());
  const double largest_mean = line->largest_mean;
  if (trend.has_settled) {
    line = second;
    trend.first_half = second->start;
  }
  trend.drift = line->drift;
  trend.walk = line->walk;
  trend.oscillation = line->oscillation;
  const double steps = scales.step > 0 ? duration / scales.step : 1;
  if (is_rounding(trend, largest_mean, steps, scales)) {
    trend.verdict = Verdict::round_off;
  } else if (trend.drift.excludes_zero()) {
    trend.verdict = Verdict::drifts;
  } else if (trend.walk * std::sqrt(duration) > trend.oscillation) {
    trend.verdict = Verdict::wanders;
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

}  // namespace qddot
