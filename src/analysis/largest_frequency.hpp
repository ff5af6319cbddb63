#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// The largest natural frequency w_max [rad/s] of -K x = w^2 M x at q, by Lanczos' method: from
// below, to a relative accuracy of about 1e-4 for some hundred products with K. An explicit method
// is stable up to a step of about 2 / w_max; frequency_bound is the cheaper bound from above.
// Zero where nothing vibrates (n = 0, or no positive w^2); infinite where a massless node has
// stiffness. Throws std::runtime_error where the iteration does not converge, and
// std::invalid_argument where the system has no K.
double largest_frequency(const System& system, const Vec& q);

// A lower bound of w_max [rad/s], mostly within some percent, for 30 products with K and no more.
// Throws std::invalid_argument where the system has no K.
double frequency_at_least(const System& system, const Vec& q);

// Whether Lanczos' method is worth its time for so many unknowns: up to 6000.
bool is_quickly_searched(const System& system);
// w_max [rad/s] where is_quickly_searched(), else the lower bound; throws as largest_frequency.
double quick_frequency(const System& system, const Vec& q);

}  // namespace qddot
