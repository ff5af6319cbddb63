#pragma once

#include <Eigen/Cholesky>

namespace qddot {

// The factors A = L L' of a small symmetric matrix, n x n, whose lower triangle is read. Eigen's
// decomposition, which takes seconds to compile, is instantiated only here.
class DenseCholesky {
 public:
  // Factorises `a`.
  explicit DenseCholesky(const Eigen::MatrixXd& a);

  // Whether A is positive definite up to rounding; all other functions need it to be.
  bool is_positive() const { return factors_.info() == Eigen::Success; }
  // An estimate of the reciprocal of A's condition in the 1-norm.
  double reciprocal_condition() const;
  // The logarithm of A's determinant.
  double log_determinant() const;

  // A^-1 B; B: n x m.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  // B = L^-1 B and B = L'^-1 B; B: n x m.
  void solve_lower(Eigen::MatrixXd& b) const;
  void solve_upper(Eigen::MatrixXd& b) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factors_;
};

}  // namespace qddot
