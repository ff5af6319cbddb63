#include "qddot/measure/speed/machine_limits.hpp"

#include <algorithm>

#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/limit_kernels.hpp"
#include "qddot/model/system.hpp"

namespace qddot::inline measure {

double triad_bandwidth(double bytes, double seconds) {
  const Index n = std::max<Index>(1, static_cast<Index>(bytes / (3 * sizeof(double))));
  Vec a = Vec::Zero(n), b = Vec::Ones(n), c = Vec::Ones(n);
  const double least =
      least_seconds(seconds, [&] { limit_kernels().triad(b.data(), c.data(), 0.5, a.data(), n); });
  return 3 * sizeof(double) * static_cast<double>(n) / least;
}

double peak_flops(double seconds) {
  double operations = 0;
  const double least =
      least_seconds(seconds, [&] { operations = limit_kernels().multiply_and_add(10000); });
  return operations / least;
}

double reading_rate(double bytes, double seconds) {
  const Index size = static_cast<Index>(bytes / sizeof(double)) / 64 * 64;
  if (size == 0) return 0;
  // Not zeros: pages that were never written are all one page of memory.
  const Vec numbers = Vec::Ones(size);
  // A pass reads at least a megabyte, so that the clock's own time does not count.
  const Index passes = std::max<Index>(1, (1 << 17) / size);
  volatile double sink = 0;
  const double least = least_seconds(seconds, [&] {
    double total = 0;
    for (Index pass = 0; pass < passes; ++pass) total += limit_kernels().sum(numbers.data(), size);
    sink = total;
  });
  return static_cast<double>(passes * size) * sizeof(double) / least;
}

}  // namespace qddot::inline measure
