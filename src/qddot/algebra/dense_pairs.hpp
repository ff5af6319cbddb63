#pragma once

#include <Eigen/Core>

namespace qddot {

// Eigenvalues, and eigenvectors in columns.
struct EigenPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

// Eigenpairs of small matrices. Values of symmetric ones ascend, and their lower triangles are
// read. Eigen's solvers, which take seconds to compile, are instantiated only here.

// A x = w x with a symmetric A; vectors of length 1.
EigenPairs dense_pairs(const Eigen::MatrixXd& a);
Eigen::VectorXd dense_values(const Eigen::Ref<const Eigen::MatrixXd>& a);
// A x = w B x with a positive definite B; x'Bx = 1.
EigenPairs dense_pairs(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
// The values of the symmetric tridiagonal matrix with `diagonal` (n), and `beside` (n - 1) next to
// it.
Eigen::VectorXd tridiagonal_values(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);
// The values of any square matrix, with their multiplicities, in no order.
Eigen::VectorXcd general_values(const Eigen::MatrixXd& a);

}  // namespace qddot
