#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// The signs of the eigenvalues of -K(q), as far as rounding allows. They count the independent
// directions in which the potential energy falls, or is flat to second order.
struct CurvatureSigns {
  int negative = 0;  // it falls, whatever rounding does
  // The sign is within rounding: something is loose, or too soft. All other eigenvalues are
  // positive.
  int flat = 0;
  // The rate [1/s] that bounds growth in flat directions; 0 without one, infinite without mass.
  double flat_rate = 0;
};

// Counts the signs at q (n). Let K~ be the K that floating point gives, and E a diagonal with
// -E <= K~ - K <= E. Then -K has no fewer negative eigenvalues than -K~ + E and no more than
// -K~ - E. Both are counted as negative pivots (Sylvester's law of inertia). So no mass enters, and
// the rounding of a stiff place does not hide a soft one elsewhere. E is the sum of
//   32 eps times the sums of K's rows and of those of Hooke's k at the same node, for the rounding
//   of lengths, of sums and of the pivots,
//   and the change of K if each position changes by its own rounding.
// If the factors turn out worse than that, E is raised. Throws std::runtime_error if K is not
// finite or cannot be factorised, and std::invalid_argument if the system has no K.
CurvatureSigns curvature_signs(const System& system, const Vec& q);

}  // namespace qddot
