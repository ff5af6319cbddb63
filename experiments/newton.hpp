#pragma once

#include "integrators/method.hpp"

namespace qddot {

// Implicit Euler by a given number of Newton's iterations (Knobs::iterations), to be laid over those
// of the methods that take a number of iterations, too: from v = v_n
//   r = M (v - v_n) - h f(q_n + h v),  p = (a M - h^2 K)^-1 r,  v = v - alpha p
// with the first alpha of 1, 1/2, 1/4, ... that lowers the energy by Armijo's rule (none: v stays).
// `newton_exact` takes K itself, and a > 1 where M - h^2 K is not positive definite;
// `newton_clamped` takes System::clamped_stiffness, for which a = 1 is enough everywhere. No
// methods of the registry: one that stops where nothing is left to gain is implicit_euler.
const Method& newton_exact();
const Method& newton_clamped();

}  // namespace qddot
