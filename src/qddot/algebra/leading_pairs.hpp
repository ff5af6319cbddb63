#pragma once

#include <functional>

#include "qddot/algebra/dense_pairs.hpp"

namespace qddot {

// y = A x for a symmetric A; y is sized by the caller.
using SymmetricOperator = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

// The `count` largest eigenpairs of a symmetric n x n operator, descending, with multiplicity. Its
// eigenvalues must not be negative, and it must be scaled to a norm of about 1; 1 <= count < n / 2.
// Lanczos' method with implicit restarts (Spectra) runs repeatedly on the rest of the space, until
// nothing larger is left. A single run sees one vector of each eigenspace; rounding alone adds
// others. Residuals |A x - lambda x| are below 1e-10 lambda, or at the operator's own rounding.
// Throws std::runtime_error if the iteration does not converge.
EigenPairs leading_pairs(const SymmetricOperator& a, Eigen::Index n, Eigen::Index count);

// The largest eigenvalue of such an operator, n >= 3, with a residual below `tolerance` times it.
// It is never above the true one but for rounding.
double leading_value(const SymmetricOperator& a, Eigen::Index n, double tolerance);

}  // namespace qddot
