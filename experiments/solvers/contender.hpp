#pragma once

#include <limits>
#include <string>
#include <vector>

#include "experiments/solvers/direct_solvers.hpp"

namespace qddot::solvers {

// A row of solvers.csv: one solver, or the limits of the machine; NaN for what is not known.
struct SolverRow {
  static constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

  std::string scene;
  Index unknowns = 0;
  std::string solver;
  double analysis = nothing, factorization = nothing, solve = nothing;  // [s]
  double gflops = nothing, gigabytes_per_second = nothing;
  double bytes = nothing;     // of the factors
  double residual = nothing;  // the largest entry of A x - b
};

// One solver with the system's M - s K, and the times that it has taken. Borrows `k`.
class Contender {
 public:
  Contender(const DirectSolverKind& kind, const System& system, double s, const SymmetricMatrix& k);

  // The seconds of a factorisation and of a solve; empty if the matrix is singular for the solver.
  std::vector<double> sample();
  void take(const std::vector<double>& sample);
  // Its least times, and what they make of its operations and bytes.
  SolverRow row(const std::string& scene) const;

  const std::string& name() const { return name_; }
  bool has_solved() const { return has_solved_; }
  double bytes() const { return solver_->bytes; }

 private:
  void factorize() { solver_->factorize(s_, k_); }
  void solve() { solver_->solve(b_, x_); }

  std::string name_;
  double s_;
  const SymmetricMatrix& k_;
  Vec b_, x_;
  std::unique_ptr<DirectSolver> solver_;
  bool has_solved_;
  double analysis_, residual_ = SolverRow::nothing;
  int factorizations_ = 0, solves_ = 0;  // calls in a sample
  double factorization_ = SolverRow::nothing, solve_ = SolverRow::nothing;
};

}  // namespace qddot::solvers
