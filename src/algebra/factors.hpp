#pragma once

#include "qddot/algebra/solver.hpp"
#include "qddot/model/system.hpp"

namespace qddot {

// Signs of a factorised symmetric matrix. `indefinite` can still be solved with by direct solvers;
// `singular` cannot.
enum class Definiteness { positive, indefinite, singular };

// Four right-hand sides or solutions of length n, row by row, so that a row is one load.
using FourColumns = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

// A way to factorise a D - s K, D diagonal and K of a pattern that is analysed once, and to solve
// with it. Functions as those of EffectiveMass. K, when factorised, must stay as it is until the
// last solve.
class Factors {
 public:
  virtual ~Factors() = default;
  virtual Definiteness factorize(double a, double s, const SymmetricMatrix& k) = 0;
  virtual bool factorize_positive(double a, double s, const SymmetricMatrix& k) = 0;
  virtual Index negative_pivots() const = 0;
  virtual SolveOutcome solve(const Vec& b, Vec& x) = 0;
  // The same for four right-hand sides at once; b, x: n x 4, sized by the caller.
  virtual SolveOutcome solve(const FourColumns& b, FourColumns& x) = 0;
  // Memory [bytes] of the factors alone, known from the analysis on: what a solve reads once
  // forwards and once backwards.
  virtual Index bytes() const = 0;
  // What an iterative solve may leave; direct ones leave rounding errors whatever is asked for.
  virtual void set_tolerance(double) {}
};

}  // namespace qddot
