#include "qddot/algebra/dense_pairs.hpp"

#include <Eigen/Eigenvalues>

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
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(a, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd tridiagonal_values(const VectorXd& diagonal, const VectorXd& beside) {
  Decomposition solver;
  solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

}  // namespace qddot
