#pragma once

#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// A small motion about a stable equilibrium p, as its natural modes give it: u = q - p, M u'' = K u
// with P = -K(p) positive definite, and perhaps air.
struct SmallMotion {
  const System& system;  // of one block, without dashpots, that is not linear
  const Vec& middle;     // p [m], n
  const State& start;    // q and v at t = 0
  // Displacements u [m] at random times of the motion; n each.
  const std::vector<Vec>& seen;
  double duration;  // T [s]
  double length;    // [m], beside which displacements are small: of the shortest spring
};

// The largest |M^-1/2 D P^-1/2| [rad/s] over displacements u, where D = K(p + u) - K(p): the force
// of D on a disturbance e is at most so many times the root of e'Pe. Infinite if P is not positive
// definite. A power iteration finds it to a tenth, which is added. `length` as in SmallMotion.
double feedback_rate(const System& system, const Vec& middle, const std::vector<Vec>& displacements,
                     double length);

// Bounds how far the motion of a system is from that of its modes in each unknown at any time up to
// T [m]; n. `feedback`: B, no less than feedback_rate() along the motion; T B <= 2. `tolerance`
// [m]: a small part of it need not be known.
//
// The distance e obeys M e'' = -P e + D e + r, r = f(p + u) - f(p) + P u: it starts at zero.
//  1. The second order of r is 1/2 sum V_abc y_b y_c in modes, V = -d(U'PU)/dy. With amplitudes A,
//     each product has two frequencies n = w_b +- w_c, and mode a answers by no more than
//       1/4 |V_abc| A_b A_c (min(T, 2/|w_a - n|) + 2/(w_a + n)) / (2 w_a),
//     which is its exact motion under that force, bounded. Resonances n = w_a grow with T. Under
//     air, w are the frequencies of damped modes, and the bound is larger by sqrt(2).
//  2. All else is a force s whose size is seen along the motion: odd and higher orders of r, and D
//     times the distance of 1. With the norm w^2 = e'^2 M + e'P e, w' <= |M^-1/2 s| + B w/2, so
//       w <= T |M^-1/2 s| exp(T B/2),   |e_i| <= w (P^-1)_ii^1/2.
// The mean over the times that are seen stands for the integral, and counts twice. For the sizes,
// displacements are enlarged to a thousandth of `length`, so that rounding of f does not count.
// Throws std::invalid_argument if the system cannot be linearised there.
Vec neglected_displacement(const SmallMotion& motion, double feedback, double tolerance);

}  // namespace qddot
