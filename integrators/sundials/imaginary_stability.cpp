#include "integrators/sundials/imaginary_stability.hpp"

#include <complex>
#include <vector>

namespace qddot::sundials {

double amplification(const ARKodeButcherTableMem& table, double y) {
  const std::complex<double> z(0, y);
  std::vector<std::complex<double>> stage(static_cast<std::size_t>(table.stages));
  std::complex<double> end = 1;
  for (int i = 0; i < table.stages; ++i) {
    auto& value = stage[static_cast<std::size_t>(i)];
    value = 1;
    for (int j = 0; j < i; ++j) value += z * table.A[i][j] * stage[static_cast<std::size_t>(j)];
    end += z * table.b[i] * value;
  }
  return std::abs(end);
}

double imaginary_stability(const ARKodeButcherTableMem& table) {
  constexpr double growth = 1e-3, resolution = 1e-3;
  // Beyond y = 2 s the leading term alone exceeds the bound.
  for (double y = resolution; y < 2 * table.stages; y += resolution) {
    if (amplification(table, y) > 1 + growth) return y - resolution;
  }
  return 2 * table.stages;
}

}  // namespace qddot::sundials
