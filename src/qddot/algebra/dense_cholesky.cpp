#include "qddot/algebra/dense_cholesky.hpp"

namespace qddot {

using Eigen::MatrixXd;

DenseCholesky::DenseCholesky(const MatrixXd& a) : factors_(a) {}

double DenseCholesky::reciprocal_condition() const { return factors_.rcond(); }

double DenseCholesky::log_determinant() const {
  return 2 * factors_.matrixLLT().diagonal().array().log().sum();
}

MatrixXd DenseCholesky::solve(const MatrixXd& b) const {
  MatrixXd x = b;
  solve_lower(x);
  solve_upper(x);
  return x;
}

void DenseCholesky::solve_lower(MatrixXd& b) const { factors_.matrixL().solveInPlace(b); }
void DenseCholesky::solve_upper(MatrixXd& b) const { factors_.matrixU().solveInPlace(b); }

}  // namespace qddot
