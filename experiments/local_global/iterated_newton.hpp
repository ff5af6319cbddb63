#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::local_global {

// Implicit Euler by a given number of Newton's iterations (Options::iterations), to be laid over
// those of the methods that take a number of iterations, too: from v = v_n
//   r = M (v - v_n) - h f(q_n + h v),  p = (M - h^2 K)^-1 r,  v = v - alpha p
// with the first alpha of 1, 1/2, 1/4, ... that lowers the energy by Armijo's rule (none: v stays).
// `newton_exact` takes K itself and, where M - h^2 K is not positive definite, as much of the
// compression as lets it be (see SplitStiffness); `newton_clamped` takes none of it ever.
// No methods of the registry: one that stops where nothing is left to gain, and keeps its factors
// as long as they serve, is implicit_euler.
const Method& newton_exact();
const Method& newton_clamped();

}  // namespace qddot::local_global
