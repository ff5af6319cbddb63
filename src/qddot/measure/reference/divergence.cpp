#include "qddot/measure/reference/divergence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/algebra/straight_line.hpp"

namespace qddot::inline measure {

Divergence divergence(const std::vector<double>& times, const std::vector<double>& differences) {
  std::vector<double> largest;
  for (const double d : differences) {
    largest.push_back(largest.empty() ? d : std::max(largest.back(), d));
  }
  const Divergence regular{std::numeric_limits<double>::infinity(), 0};
  if (largest.empty() || largest.front() > far_apart / 10 ||
      !(largest.back() > exponential_growth * largest.front()))
    return regular;

  const auto first_above = [&](double bound) {
    return static_cast<std::size_t>(std::ranges::upper_bound(largest, bound) - largest.begin());
  };
  const std::size_t free = first_above(far_apart / 10), near = first_above(far_apart);
  const double middle = (times.front() + times[free - 1]) / 2;
  std::vector<double> t, logarithm;
  // Two points at least, however few looks there are before the horizon.
  const std::size_t end = std::max<std::size_t>(free, 2);
  for (std::size_t i = 0; i < end; ++i) {
    if (times[i] < middle && i + 2 < end) continue;
    t.push_back(times[i]);
    logarithm.push_back(std::log(largest[i]));
  }
  const double lyapunov = straight_line(t, logarithm).slope;
  if (near < times.size()) return {times[near], lyapunov};
  if (!(lyapunov > 0)) return regular;
  return {times.back() + std::log(far_apart / largest.back()) / lyapunov, lyapunov};
}

}  // namespace qddot::inline measure
