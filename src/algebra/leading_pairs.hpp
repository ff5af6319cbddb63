#pragma once

#include <functional>

#include "qddot/algebra/dense_pairs.hpp"

namespace qddot {

// y = A x for a symmetric A; y is sized by the caller.
using SymmetricOperator = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

// The `count` largest eigenvalues of a symmetric n x n operator, descending, as often as they are
// multiple. They must not be negative, and the operator must be scaled to a norm of about 1;
// 1 <= count < n / 2. By Lanczos' method with implicit restarts (Spectra), again and again with
// what is found projected out until nothing above it is left: from one starting vector Lanczos sees
// a single vector of each eigenspace, and its further ones only as rounding brings them in.
// Residuals |A x - lambda x| are below 1e-10 lambda, or at the operator's own rounding. Throws
// std::runtime_error where the iteration does not converge.
EigenPairs leading_pairs(const SymmetricOperator& a, Eigen::Index n, Eigen::Index count);

// The largest eigenvalue of such an operator, n >= 3, with residual below `tolerance` times it and
// never above the true one but for rounding.
double leading_value(const SymmetricOperator& a, Eigen::Index n, double tolerance);

}  // namespace qddot
