#pragma once

#include <cstdio>  // which ARKODE's header forgets

#include <arkode/arkode_butcher.h>

namespace qddot::sundials {

// |R(iy)|, R(z) = 1 + z b'(I - z A)^-1 1: by how much a step of h w = y of an explicit table
// multiplies the amplitude on q'' = -w^2 q (Hairer and Wanner, Solving ODEs II, section IV.2).
double amplification(const ARKodeButcherTableMem& table, double y);

// The largest y up to which an explicit table lets no vibration grow by more than a thousandth a
// step. Tables that let all of them grow, however slowly, as those of order 2 and some of order 5
// do, have such a limit too; errors below it are the error test's business.
double imaginary_stability(const ARKodeButcherTableMem& table);

}  // namespace qddot::sundials
