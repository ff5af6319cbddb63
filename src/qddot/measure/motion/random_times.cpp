#include "qddot/measure/motion/random_times.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "qddot/integrators/base/step_times.hpp"

namespace qddot::inline measure {
namespace {

// A random number in (0, 1], the same with every standard library.
double drawn(std::mt19937_64& random) {
  return 1 - std::ldexp(static_cast<double>(random() >> 11), -53);
}

}  // namespace

std::vector<double> random_times(double until, std::int64_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const double length = until / static_cast<double>(count);
  std::vector<double> times;
  for (std::int64_t cell = 0; cell + 1 < count; ++cell) {
    const double t = std::min(until, (static_cast<double>(cell) + drawn(random)) * length);
    if (t > 0) times.push_back(t);
  }
  times.push_back(until);
  return times;
}

std::vector<double> random_step_times(double h, double until, std::int64_t count,
                                      std::uint64_t seed) {
  const StepTimes steps(0, until, h);
  std::mt19937_64 random(seed);
  const double cells = std::min(static_cast<double>(count), steps.count());
  std::vector<double> times;
  for (double cell = 0; cell + 1 < cells; ++cell) {
    const double first = std::floor(steps.count() * cell / cells) + 1;
    const double last = std::floor(steps.count() * (cell + 1) / cells);
    times.push_back(steps.after(first + std::floor((last - first + 1) * (1 - drawn(random)))));
  }
  times.push_back(until);
  return times;
}

}  // namespace qddot::inline measure
