#pragma once

#include <Eigen/Core>

#include "qddot/model/system.hpp"

namespace qddot {

// Pairs of -K(q) x = w^2 M x: small motions about q are sums of x cos(w t), or of x e^(|w| t) where
// w^2 < 0 and the shape grows.
struct NaturalModes {
  Vec squares;             // w^2 [1/s^2], ascending
  Eigen::MatrixXd shapes;  // x, a column each, x'Mx = 1 (x in kg^-1/2)
};

// How many finite natural frequencies there are: one for each unknown with mass. A massless unknown
// only follows the others; its frequency is infinite.
Index finite_modes(const System& system);

// The `count` lowest modes at q, all finite ones where there are no more; those of negative w^2 are
// the very lowest. Each as often as it is multiple (a free body in space at rest has six of w = 0).
// Small systems by dense decomposition; large ones by Lanczos' method on (-K - s M)^-1 M, with the
// shift s below all w^2, found by trying which matrix is positive definite, and as near to the
// lowest as they are small. w^2 is right to what rounding of K leaves at the places that move in
// the shape; whether that hides its sign, curvature_signs() tells.
// Throws std::domain_error where a massless unknown is not held by its springs (-K among the
// massless is not positive definite), so that M q'' = f(q) does not say how it moves. Throws
// std::invalid_argument where the system has no K.
NaturalModes lowest_modes(const System& system, const Vec& q, Index count);

// The same with another diagonal (n entries, >= 0) in place of M.
NaturalModes lowest_modes(const System& system, const Vec& q, Index count, const Vec& mass);

// The `count` highest of the finite modes at q, ascending like the lowest and found like them, with
// a shift above all finite w^2. Throws as they do.
NaturalModes highest_modes(const System& system, const Vec& q, Index count);

}  // namespace qddot
