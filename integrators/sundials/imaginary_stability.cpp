#include "integrators/sundials/imaginary_stability.hpp"

#include <vector>

namespace qddot::sundials {

std::complex<double> stability_function(const ARKodeButcherTableMem& table,
                                        std::complex<double> z) {
  std::vector<std::complex<double>> stage(static_cast<std::size_t>(table.stages));
  std::complex<double> end = 1;
  for (int i = 0; i < table.stages; ++i) {
    auto& value = stage[static_cast<std::size_t>(i)];
    value = 1;
    for (int j = 0; j < i; ++j) value += z * table.A[i][j] * stage[static_cast<std::size_t>(j)];
    end += z * table.b[i] * value;
  }
  return end;
}

double imaginary_stability(const std::function<std::complex<double>(std::complex<double>)>& r,
                           int stages) {
  constexpr double growth = 1e-3, resolution = 1e-3;
  // Beyond y = 2 s the leading term alone exceeds the bound.
  for (double y = resolution; y < 2 * stages; y += resolution) {
    if (std::abs(r({0, y})) > 1 + growth) return y - resolution;
  }
  return 2 * stages;
}

double imaginary_stability(const ARKodeButcherTableMem& table) {
  return imaginary_stability([&](std::complex<double> z) { return stability_function(table, z); },
                             table.stages);
}

}  // namespace qddot::sundials
