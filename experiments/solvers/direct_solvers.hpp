#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "qddot/model/system.hpp"

namespace qddot::solvers {

// One way to solve with M - s K directly; all functions may be called again and again.
class DirectSolver {
 public:
  virtual ~DirectSolver() = default;
  // The numeric factorisation of M - s K; whether there is something to solve with.
  virtual bool factorize(double s, const SymmetricMatrix& k) = 0;
  // x = (M - s K)^-1 b with the last factors; b, x: n.
  virtual void solve(const Vec& b, Vec& x) = 0;

  // `flops`: additions and multiplications of one factorisation. `bytes`: those of the factors that
  // a solve reads (twice, if they are L and its transpose). 0 if the solver does not report them.
  double flops = 0, bytes = 0;
};

struct DirectSolverKind {
  std::string name;
  // Analyses the system's pattern. The system must outlive the solver.
  std::function<std::unique_ptr<DirectSolver>(const System&)> make;
};

// The solvers. multifrontal and cholmod: see effective_mass.hpp. eigen: its simplicial LDL' with
// the ordering AMD. klu: factors of the 2n x 2n matrix of the first-order form with the pivots of
// the first time, as SUNDIALS' users have it.
const std::vector<DirectSolverKind>& direct_solvers();

// The rate [operations/s] at which one core multiplies dense matrices in its second cache. The
// installed BLAS does so with the widest vectors of the processor. The fastest of all passes in
// `seconds`.
double product_flops(double seconds);

// A row of solvers.csv: one solver, or the limits of the machine; NaN for what is not known.
struct SolverRow {
  static constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

  std::string scene{};
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

  const std::string& name() const { return row_.solver; }
  bool has_solved() const { return has_solved_; }
  double bytes() const { return solver_->bytes; }

 private:
  void factorize() { solver_->factorize(s_, k_); }
  void solve() { solver_->solve(b_, x_); }

  double s_;
  const SymmetricMatrix& k_;
  Vec b_, x_;
  std::unique_ptr<DirectSolver> solver_;
  bool has_solved_;
  int factorizations_ = 0, solves_ = 0;  // calls in a sample
  SolverRow row_;
};

}  // namespace qddot::solvers
