#pragma once

#include <Eigen/Core>

#include "qddot/model/system.hpp"

namespace qddot {

// Eigenpairs of -K(q) x = w^2 M x. Small motions about q are sums of x cos(w t) or, if w^2 < 0, of
// growing x e^(|w| t).
struct NaturalModes {
  Vec squares;             // w^2 [1/s^2], ascending
  Eigen::MatrixXd shapes;  // x, one in each column, x'Mx = 1 (x in kg^-1/2)
};

// The number of finite natural frequencies: one for each unknown with mass. A massless unknown
// follows the others; its frequency is infinite.
Index finite_modes(const System& system);

// The `count` lowest modes at q (n), or all finite ones if there are fewer; negative w^2 come
// first. Each is given with its multiplicity (a free body in space at rest has six of w = 0). Small
// systems use a dense decomposition, large ones Lanczos' method on (-K - s M)^-1 M. The shift s is
// below all w^2 and near to the lowest; a search for positive definite matrices finds it. The error
// of w^2 is the rounding of K at the places that move in the shape; curvature_signs() tells whether
// it hides the sign. Throws std::domain_error if springs do not hold a massless unknown: -K among
// the massless is not positive definite, and M q'' = f(q) does not determine its motion. Throws
// std::invalid_argument if the system has no K.
NaturalModes lowest_modes(const System& system, const Vec& q, Index count);

// The same with another diagonal (n entries, >= 0) in place of M.
NaturalModes lowest_modes(const System& system, const Vec& q, Index count, const Vec& mass);

// The `count` highest finite modes at q, ascending, found like the lowest with a shift above all
// finite w^2. Throws as they do.
NaturalModes highest_modes(const System& system, const Vec& q, Index count);

// The damping ratio zeta = x'C(q)x/(2 w) of a mode of shape x (n, x'Mx = 1) and w = omega [rad/s] >
// 0, by its own damping alone: C may also couple modes. Zero without Damping.
double damping_ratio(const System& system, const Vec& q, const Vec& shape, double omega);

}  // namespace qddot
