#include "qddot/algebra/dense_pairs.hpp"

#include <Eigen/Eigenvalues>

#include "qddot/algebra/dense_cholesky.hpp"

namespace qddot {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Decomposition = Eigen::SelfAdjointEigenSolver<MatrixXd>;

EigenPairs dense_pairs(const MatrixXd& a) {
  const Decomposition solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd dense_values(const Eigen::Ref<const MatrixXd>& a) {
  return Decomposition(a, Eigen::EigenvaluesOnly).eigenvalues();
}

EigenPairs dense_pairs(const MatrixXd& a, const MatrixXd& b) {
  // B = L L' turns this into (L^-1 A L'^-1) y = w y with x = L'^-1 y.
  const DenseCholesky root(b);
  MatrixXd c = a.selfadjointView<Eigen::Lower>();
  root.solve_lower(c);
  c.transposeInPlace();
  root.solve_lower(c);
  EigenPairs pairs = dense_pairs(c);
  root.solve_upper(pairs.vectors);
  return pairs;
}

VectorXd tridiagonal_values(const VectorXd& diagonal, const VectorXd& beside) {
  Decomposition solver;
  solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

Eigen::VectorXcd general_values(const MatrixXd& a) {
  return Eigen::EigenSolver<MatrixXd>(a, false).eigenvalues();
}

}  // namespace qddot
