#include "experiments/verdicts/tally.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/trend/sample_steps.hpp"

namespace qddot::verdicts {

Interval Coverage::interval() const {
  const double n = said, p = held / n, z = 1.959964;
  const double middle = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {p, middle - half, middle + half};
}

void Tally::add(const SyntheticKind& kind, const Trend& trend) {
  constexpr double duration = synthetic_duration;
  ++verdicts[trend.verdict];
  if (kind.drift) {
    coverage["drift_rate"].add(trend.drift.holds(*kind.drift / duration));
    coverage["late_drift"].add(trend.late_drift.holds(*kind.drift / duration));
  }
  if (kind.rate && trend.rate.value != 0) {
    coverage["exponential_rate"].add(trend.rate.holds(*kind.rate / duration));
  }
  if (kind.widening) coverage["widening"].add(trend.widening.holds(*kind.widening / duration));
  if (kind.memory && trend.colour == Colour::undecided) {
    coverage["memory_low"].add(trend.memory <= *kind.memory * duration);
  }
  if (kind.period && *kind.period >= 1 && trend.slow_period > 0) {
    coverage["slow_period_low"].add(trend.slow_period <= *kind.period * duration);
  }
  if (kind.walk) walk += trend.walk * std::sqrt(duration) / *kind.walk;
}

const char* judgement(const SyntheticKind& kind, Verdict verdict) {
  if (std::ranges::count(kind.right, verdict) > 0) return "right";
  const bool claims_nothing = verdict == Verdict::undecided || verdict == Verdict::unknown;
  return claims_nothing ? "uncertain" : "wrong";
}

Tally tally(const SyntheticKind& kind, int seeds, int cells) {
  std::vector<Trend> trends(static_cast<std::size_t>(seeds));
#pragma omp parallel for schedule(dynamic)
  for (std::size_t seed = 0; seed < trends.size(); ++seed) {
    if (!interrupted()) trends[seed] = synthetic_trend(kind, seed, cells);
  }
  Tally result;
  stop_if_interrupted();
  for (const Trend& trend : trends) result.add(kind, trend);
  result.walk /= seeds;
  return result;
}

}  // namespace qddot::verdicts
