#pragma once

#include <memory>

#include "qddot/algebra/factors.hpp"
#include "qddot/model/system.hpp"

namespace qddot {

// Solves (a M - s K) x = b: the n x n matrix of every implicit stage of M q'' = f(q).
// The pattern is the system's, so the ordering and symbolic analysis are made once, here; each
// factorize() is numeric only.
class EffectiveMass {
 public:
  // Signs of the factorised matrix. `indefinite` (compressed springs outweigh the mass) can still
  // be solved with; `singular` cannot.
  using Definiteness = qddot::Definiteness;

  // Without a solver named, a direct one, which all that is said below is true of; what is
  // different with conjugate gradients is said in conjugate_gradients.hpp.
  explicit EffectiveMass(const System& system, Solver solver = Solver::multifrontal);
  // The same with another diagonal (n entries) in place of the system's masses.
  EffectiveMass(const System& system, Vec diagonal, Solver solver = Solver::multifrontal);

  // Factorises a M - s K, K with the system's pattern; in an implicit stage a >= 0, s [s^2] >= 0.
  // An indefinite matrix is factorised as LDL' without pivoting. Throws std::runtime_error when out
  // of memory.
  Definiteness factorize(double a, double s, const SymmetricMatrix& k) {
    return factors_->factorize(a, s, k);
  }

  // The same, but gives up (false, nothing to solve with) unless the matrix is positive definite:
  // cheaper where an indefinite one is of no use.
  bool factorize_positive(double a, double s, const SymmetricMatrix& k) {
    return factors_->factorize_positive(a, s, k);
  }

  // How many eigenvalues of the last factorised matrix are negative (Sylvester's law of inertia);
  // it must not have been singular.
  Index negative_pivots() const { return factors_->negative_pivots(); }

  // x = (a M - s K)^-1 b with the last factors, which must not be singular; b, x: n. A direct
  // solver always finds it; where it is not found x is of no use.
  SolveOutcome solve(const Vec& b, Vec& x) { return factors_->solve(b, x); }

  // What part of b an iterative solve may leave; others do not care.
  void set_tolerance(double tolerance) { factors_->set_tolerance(tolerance); }

  // Memory [bytes] that the factors take, workspace and the analysis' indices left out.
  Index bytes() const { return factors_->bytes(); }

 private:
  std::unique_ptr<Factors> factors_;
};

}  // namespace qddot
