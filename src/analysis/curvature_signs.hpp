#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// In how many independent directions the potential energy falls and stays flat to second order:
// the signs of the eigenvalues of -K(q), as far as rounding lets them be told.
struct CurvatureSigns {
  int negative = 0;  // it falls, whatever rounding does
  // Rounding decides: something is loose, or its sign cannot be told. All others are positive.
  int flat = 0;
  // No motion in a flat direction grows faster [1/s]; 0 without one, infinite without mass.
  double flat_rate = 0;
};

// With a diagonal E of which is known that -E <= K~ - K <= E, K~ being what comes out in floating
// point: the eigenvalues of -K~ + E that are negative are so of -K too, and no more of -K are than
// of -K~ - E. Both are counted as negative pivots (Sylvester's law of inertia), so that no mass
// enters, and a soft place is not measured by the rounding of a stiff one elsewhere. E is
//   32 eps times the sums of K's rows and of those of Hooke's k at the same node, for the rounding
//   of lengths, of sums and of the pivots,
//   and what K changes by where each position changes by its own rounding.
// Where the factors turn out worse than that, E is raised to what they are.
// Throws std::runtime_error where K is not finite or cannot be factorised, and
// std::invalid_argument where the system has no K.
CurvatureSigns curvature_signs(const System& system, const Vec& q);

}  // namespace qddot
