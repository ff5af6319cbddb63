#pragma once

#include <cstdio>  // missing in the headers of ARKODE 6

#include <arkode/arkode_butcher.h>

namespace qddot::sundials {

// |R(iy)|, R(z) = 1 + z b'(I - z A)^-1 1: a step of an explicit table multiplies the amplitude of
// q'' = -w^2 q by this, y = h w (Hairer and Wanner, Solving ODEs II, section IV.2).
double amplification(const ARKodeButcherTableMem& table, double y);

// The largest y up to which an explicit table lets no vibration grow by more than a thousandth a
// step. Some tables let all vibrations grow slowly, as those of order 2 and some of order 5; they
// have such a limit too. Smaller growth is left to the error test.
double imaginary_stability(const ARKodeButcherTableMem& table);

}  // namespace qddot::sundials
