#pragma once

#include "src/model/system.hpp"

namespace qddot {

// The masses [kg] (n) with the mean of the positive ones in place of zeros, ones where no node has
// mass: a metric of all unknowns.
Vec metric_of_all(const System& system);

// In how many independent directions the potential energy falls from q to second order: the number
// of negative eigenvalues of -K(q), by the inertia (negative pivots) of tau M' - K, M' as above.
// Counted is what is below -tau, tau = 1e-10 of Gershgorin's bound of M'^-1 K: rounding makes some
// 1e-15 of it, so that a body that is free or slack counts as stable. Throws std::runtime_error
// where K is not finite.
int unstable_directions(const System& system, const Vec& q);

// The smallest eigenvalue of -K(q) [N/m] and its eigenvector of length 1 (n): negative where the
// energy falls, zero within rounding (1e-15 of the largest row sum of |K|) where something is
// loose.
struct Curvature {
  double value = 0;
  Vec direction{};
};
// Throws std::invalid_argument where n = 0.
Curvature smallest_curvature(const System& system, const Vec& q);

// max_i sum_j |K_ij(q)| [N/m], zero where n = 0.
double largest_row_sum(const SymmetricMatrix& k);

}  // namespace qddot
