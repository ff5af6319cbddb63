#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// An upper bound of the largest natural frequency w_max [rad/s] of -K x = w^2 M x at q (n).
// Gershgorin's circles of M^-1 K give w^2 <= max_i sum_j |K_ij| / m_i. Zero if n = 0; infinite if a
// massless node has stiffness. Throws std::invalid_argument if the system has no K.
double frequency_bound(const System& system, const Vec& q);
// The same for given masses (n) and K. `row_sums` is scratch, of any length.
double frequency_bound(const Vec& mass, const SymmetricMatrix& k, Vec& row_sums);

}  // namespace qddot
