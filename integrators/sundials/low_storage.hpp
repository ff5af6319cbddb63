#pragma once

#include <complex>

namespace qddot::sundials {

// R(z) of the strong-stability-preserving formulas in low_storage.cpp: the products of their steps
// of Euler's method, each of which multiplies by e = 1 + z/c.
inline std::complex<double> growth_of_ssp3(std::complex<double> z) {
  const auto e = 1. + z / 2.;
  return e * (2. + e * e * e) / 3.;
}
inline std::complex<double> growth_of_ssp4(std::complex<double> z) {
  const auto e = 1. + z / 6., e5 = e * e * e * e * e;
  return (1. + 18. * e5 + 6. * e5 * e5) / 25.;
}

}  // namespace qddot::sundials
