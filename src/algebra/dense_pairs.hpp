#pragma once

#include <Eigen/Core>

namespace qddot {

// Eigenvalues and, in columns, their vectors.
struct EigenPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

// Eigenpairs of small matrices; values of symmetric ones ascend, and their lower triangles are
// read. Here alone Eigen's solvers are instantiated, which takes seconds.

// A x = w x; vectors of length 1.
EigenPairs dense_pairs(const Eigen::MatrixXd& a);
Eigen::VectorXd dense_values(const Eigen::Ref<const Eigen::MatrixXd>& a);
// A x = w B x with a positive definite B; x'Bx = 1.
EigenPairs dense_pairs(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
// The values of a symmetric tridiagonal matrix with these numbers on and beside the diagonal.
Eigen::VectorXd tridiagonal_values(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);
// The values of any square matrix, as often as they are roots; in no order.
Eigen::VectorXcd general_values(const Eigen::MatrixXd& a);

}  // namespace qddot
