#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// The masses [kg] (n) with the mean of the positive ones in place of zeros, ones where no node has
// mass: a metric of all unknowns.
Vec metric_of_all(const System& system);

// The smallest eigenvalue of -K(q) [N/m] and its eigenvector of length 1 (n). Whether it is zero
// within rounding, curvature_signs() tells.
struct Curvature {
  double value = 0;
  Vec direction{};
};
// Throws std::invalid_argument where n = 0 or the system has no K.
Curvature smallest_curvature(const System& system, const Vec& q);

// sum_j |K_ij| [N/m] (n), and the largest of them, zero where n = 0.
Vec row_sums(const SymmetricMatrix& k);
double largest_row_sum(const SymmetricMatrix& k);

}  // namespace qddot
