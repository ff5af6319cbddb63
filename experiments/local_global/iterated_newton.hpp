#pragma once

#include "qddot/integrators/method.hpp"

namespace qddot::local_global {

// Implicit Euler by a given number of Newton's iterations (Options::iterations), for comparison
// with the other methods of a given number of iterations. It starts at v = v_n and iterates
//   r = M (v - v_n) - h f(q_n + h v),  p = (M - h^2 K)^-1 r,  v = v - alpha p
// with the first alpha of 1, 1/2, 1/4, ... that lowers the energy by Armijo's rule (none: v stays).
// `newton_exact` uses K itself. If M - h^2 K is not positive definite, it uses as much of the
// compression as keeps it so (see SplitStiffness). `newton_clamped` never uses compression.
// Both are not in the registry. Its implicit_euler stops when iterations gain nothing more, and
// keeps its factors as long as they serve.
const Method& newton_exact();
const Method& newton_clamped();

}  // namespace qddot::local_global
