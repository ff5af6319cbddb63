#include "qddot/measure/reference/divergence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qddot::measure {
namespace {

// The slope of y over x by least squares; zero for less than two x.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto mean = [](const std::vector<double>& a) {
    double sum = 0;
    for (const double value : a) sum += value;
    return sum / static_cast<double>(a.size());
  };
  const double x_mean = mean(x), y_mean = mean(y);
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - x_mean) * (x[i] - x_mean);
    xy += (x[i] - x_mean) * (y[i] - y_mean);
  }
  return xx > 0 ? xy / xx : 0;
}

}  // namespace

Divergence divergence(const std::vector<double>& times, const std::vector<double>& differences) {
  std::vector<double> largest;
  for (const double d : differences) {
    largest.push_back(largest.empty() ? d : std::max(largest.back(), d));
  }
  const Divergence regular{std::numeric_limits<double>::infinity(), 0};
  if (largest.empty() || largest.front() > apart / 10 ||
      !(largest.back() > exponential_growth * largest.front()))
    return regular;

  const auto first_above = [&](double bound) {
    return static_cast<std::size_t>(std::ranges::upper_bound(largest, bound) - largest.begin());
  };
  const std::size_t free = first_above(apart / 10), near = first_above(apart);
  const double middle = (times.front() + times[free - 1]) / 2;
  std::vector<double> t, logarithm;
  for (std::size_t i = 0; i < free; ++i) {
    if (times[i] < middle) continue;
    t.push_back(times[i]);
    logarithm.push_back(std::log(largest[i]));
  }
  const double lyapunov = slope(t, logarithm);
  if (near < times.size()) return {times[near], lyapunov};
  if (!(lyapunov > 0)) return regular;
  return {times.back() + std::log(apart / largest.back()) / lyapunov, lyapunov};
}

}  // namespace qddot::measure
