#pragma once

#include <memory>

#include "qddot/algebra/factors.hpp"
#include "qddot/model/system.hpp"

namespace qddot {

// Solves (a M - s K) x = b, the n x n system of every implicit stage of M q'' = f(q). The
// constructor orders and analyses the system's pattern once; each factorize() is numeric only.
class EffectiveMass {
 public:
  // Signs of the factorised matrix. An `indefinite` one (compressed springs outweigh the mass) can
  // still be solved with; a `singular` one cannot.
  using Definiteness = qddot::Definiteness;

  // The functions are described for direct solvers, such as the default; see also
  // conjugate_gradients.hpp.
  explicit EffectiveMass(const System& system, Solver solver = Solver::multifrontal);
  // The same with another diagonal (n entries) in place of the system's masses.
  EffectiveMass(const System& system, Vec diagonal, Solver solver = Solver::multifrontal);

  // Factorises a M - s K; k has the system's pattern. An implicit stage has a >= 0, s [s^2] >= 0.
  // An indefinite matrix is factorised as LDL' without pivoting. Throws std::runtime_error when out
  // of memory.
  Definiteness factorize(double a, double s, const SymmetricMatrix& k) {
    return factors_->factorize(a, s, k);
  }

  // The same, but gives up (false, nothing to solve with) unless the matrix is positive definite:
  // cheaper if an indefinite one is of no use.
  bool factorize_positive(double a, double s, const SymmetricMatrix& k) {
    return factors_->factorize_positive(a, s, k);
  }

  // The number of negative eigenvalues of the last factorised matrix (Sylvester's law of inertia),
  // which must not have been singular.
  Index negative_pivots() const { return factors_->negative_pivots(); }

  // x = (a M - s K)^-1 b with the last factors, which must not be singular; b, x: n. A direct
  // solver always finds x. If it is not found, x is of no use.
  SolveOutcome solve(const Vec& b, Vec& x) { return factors_->solve(b, x); }

  // Sets which part of b an iterative solve may leave as residual; direct solvers ignore it.
  void set_tolerance(double tolerance) { factors_->set_tolerance(tolerance); }

  // Memory [bytes] of the factors, without workspace and the indices of the analysis.
  Index bytes() const { return factors_->bytes(); }

 private:
  std::unique_ptr<Factors> factors_;
};

}  // namespace qddot
