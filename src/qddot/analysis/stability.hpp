#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// The masses [kg] (n) with zeros replaced by the mean of the positive ones, or ones if no node has
// mass: a metric of all unknowns.
Vec metric_of_all(const System& system);

// The smallest eigenvalue of -K(q) [N/m] and its eigenvector of length 1 (n). curvature_signs()
// tells whether it is zero within rounding.
struct Curvature {
  double value = 0;
  Vec direction{};
};
// Computes them at q (n). Throws std::invalid_argument if n = 0 or the system has no K.
Curvature smallest_curvature(const System& system, const Vec& q);

// The row sums sum_j |K_ij| [N/m] (n), and the largest of them, zero if n = 0.
Vec row_sums(const SymmetricMatrix& k);
double largest_row_sum(const SymmetricMatrix& k);

}  // namespace qddot
