#include "experiments/machine_limits.hpp"

#include <algorithm>

#include <Eigen/Dense>

#include "experiments/timing.hpp"
#include "src/algebra/large_array.hpp"

namespace qddot {
namespace {

constexpr double seconds_spent = 0.1;

// The shortest of the wall times of work() [s], over as many as fit.
template <class Work>
double fastest(const Work& work) {
  double best = seconds_of(work);
  for (double spent = best; spent < seconds_spent;) {
    const double seconds = seconds_of(work);
    best = std::min(best, seconds);
    spent += seconds;
  }
  return best;
}

}  // namespace

double peak_flops() {
  constexpr Index n = 480;  // three of them lie in the second cache or close by
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(n, n, 0.5), b = a;
  Eigen::MatrixXd c(n, n);
  return 2.0 * n * n * n / fastest([&] { c.noalias() = a * b; });
}

double reading_rate(double bytes) {
  const Index size = static_cast<Index>(bytes / sizeof(double)) / 64 * 64;
  if (size == 0) return 0;
  const LargeArray numbers(size);
  // A pass of at least a megabyte, so that the clock's own time does not count.
  const Index passes = std::max<Index>(1, (1 << 17) / size);
  Eigen::Array<double, 64, 1> sums = Eigen::Array<double, 64, 1>::Zero();
  volatile double sink = 0;
  const double seconds = fastest([&] {
    for (Index pass = 0; pass < passes; ++pass) {
      for (Index i = 0; i < size; i += 64)
        sums += Eigen::Map<const Eigen::Array<double, 64, 1>>(numbers.get() + i);
    }
    sink = sums.sum();
  });
  return static_cast<double>(passes * size) * sizeof(double) / seconds;
}

}  // namespace qddot
