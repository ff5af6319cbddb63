#include "qddot/measure/speed/machine_limits.hpp"

#include <algorithm>

#include <Eigen/Dense>

#include "qddot/measure/motion/timing.hpp"
#include "qddot/model/kernels/lanes.hpp"
#include "qddot/model/system.hpp"

namespace qddot::measure {
namespace {

using namespace kernels;

// More chains of dependent operations than two units of latency 4 need.
constexpr int chains = 12, rounds = 10000;

}  // namespace

double triad_bandwidth(double bytes, double seconds) {
  const Index n = std::max<Index>(1, static_cast<Index>(bytes / (3 * sizeof(double))));
  Vec a = Vec::Zero(n), b = Vec::Ones(n), c = Vec::Ones(n);
  double s = 0.5;
  const double least = least_seconds(seconds, [&] {
    a = b + s * c;
    asm volatile("" : "+m"(s) : "r"(a.data()) : "memory");  // a pass is not left out
  });
  return 3 * sizeof(double) * static_cast<double>(n) / least;
}

double peak_flops(double seconds) {
  struct Chains {
    Lanes each[chains];
  } x{};
  Lanes factor = 0.5 + Lanes{}, term = 1 + Lanes{};
  const double least = least_seconds(seconds, [&] {
    asm volatile("" : "+m"(factor), "+m"(term));
    const Lanes m = factor, t = term;
    Chains y = x;
    for (int i = 0; i < rounds; ++i) {
#pragma GCC unroll 16
      for (Lanes& chain : y.each) chain = chain * m + t;
    }
    x = y;
    asm volatile("" : "+m"(x));
  });
  return 2.0 * lanes * chains * rounds / least;
}

double product_flops(double seconds) {
  constexpr Index n = 480;  // three of them lie in the second cache or close by
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(n, n, 0.5), b = a;
  Eigen::MatrixXd c(n, n);
  const int threads = Eigen::nbThreads();
  Eigen::setNbThreads(1);
  const double least = least_seconds(seconds, [&] { c.noalias() = a * b; });
  Eigen::setNbThreads(threads);
  return 2.0 * n * n * n / least;
}

double reading_rate(double bytes, double seconds) {
  const Index size = static_cast<Index>(bytes / sizeof(double)) / 64 * 64;
  if (size == 0) return 0;
  const Vec numbers = Vec::Zero(size);
  // A pass of at least a megabyte, so that the clock's own time does not count.
  const Index passes = std::max<Index>(1, (1 << 17) / size);
  Eigen::Array<double, 64, 1> sums = Eigen::Array<double, 64, 1>::Zero();
  volatile double sink = 0;
  const double least = least_seconds(seconds, [&] {
    for (Index pass = 0; pass < passes; ++pass) {
      for (Index i = 0; i < size; i += 64)
        sums += Eigen::Map<const Eigen::Array<double, 64, 1>>(numbers.data() + i);
    }
    sink = sums.sum();
  });
  return static_cast<double>(passes * size) * sizeof(double) / least;
}

}  // namespace qddot::measure
