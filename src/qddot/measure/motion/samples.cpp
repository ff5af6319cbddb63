#include "qddot/measure/motion/samples.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline measure {
namespace {

// Times with a relative difference below this differ by rounding only.
constexpr double time_rounding = 1e-12;
constexpr double most_samples = 1e8;

}  // namespace

std::vector<double> samples(double every, double until) {
  if (every == 0) return {};
  const double count = std::floor(until / every * (1 + time_rounding));
  if (!(count <= most_samples)) {
    throw InvalidInput(fmt::format("--every {}: {} samples up to {} s are too many; allowed are {}",
                                   every, count, until, most_samples));
  }
  std::vector<double> times;
  for (double k = 0; k <= count; ++k) times.push_back(k * every);
  if (std::abs(times.back() - until) <= time_rounding * until) times.back() = until;
  return times;
}

std::vector<double> merged(const std::vector<std::vector<double>>& lists) {
  std::vector<double> times;
  for (const auto& list : lists) times.insert(times.end(), list.begin(), list.end());
  std::ranges::sort(times);
  const auto same = [](double s, double t) { return t - s <= time_rounding * t; };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  if (!times.empty() && times.front() == 0) times.erase(times.begin());
  return times;
}

bool is_sample(const std::vector<double>& times, double t) {
  const auto found = std::ranges::lower_bound(times, t * (1 - time_rounding));
  return found != times.end() && *found <= t * (1 + time_rounding);
}

}  // namespace qddot::inline measure
