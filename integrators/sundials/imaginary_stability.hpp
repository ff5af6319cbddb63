#pragma once

#include <complex>
#include <cstdio>  // missing in the headers of ARKODE 6
#include <functional>

#include <arkode/arkode_butcher.h>

namespace qddot::sundials {

// R(z) = 1 + z b'(I - z A)^-1 1 of an explicit table: a step multiplies the amplitude of
// q'' = -w^2 q by |R(i h w)| (Hairer and Wanner, Solving ODEs II, section IV.2).
std::complex<double> stability_function(const ARKodeButcherTableMem& table, std::complex<double> z);

// The largest y up to which an explicit formula of that many stages lets no vibration grow by more
// than a thousandth a step: |R(iy)| < 1.001. Some formulas let all vibrations grow slowly, as those
// of order 2 and some of order 5; they have such a limit too. Smaller growth is left to the error
// test.
double imaginary_stability(const std::function<std::complex<double>(std::complex<double>)>& r,
                           int stages);
double imaginary_stability(const ARKodeButcherTableMem& table);

}  // namespace qddot::sundials
