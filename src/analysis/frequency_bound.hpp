#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// An upper bound of the largest natural frequency w_max [rad/s] of -K x = w^2 M x at q, by
// Gershgorin's circles of M^-1 K: w^2 <= max_i sum_j |K_ij| / m_i. Zero where n = 0; infinite
// where a massless node has stiffness. Throws std::invalid_argument where the system has no K.
double frequency_bound(const System& system, const Vec& q);
// The same for masses and a K that are there already. `row_sums` is scratch, of any length.
double frequency_bound(const Vec& mass, const SymmetricMatrix& k, Vec& row_sums);

}  // namespace qddot
