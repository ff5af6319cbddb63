#pragma once

#include <memory>

#include "qddot/algebra/solver.hpp"
#include "qddot/model/system.hpp"

namespace qddot {

struct SymbolicFactorization;

// Signs of a factorised symmetric matrix. Direct solvers can still solve with an `indefinite` one;
// no solver can with a `singular` one.
enum class Definiteness { positive, indefinite, singular };

// Four right-hand sides or solutions, n x 4, row by row, so that one load reads a row.
using FourColumns = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

// Factorises a D - s K and solves with it; the functions are those of EffectiveMass. It is made
// from K's pattern (n x n), which is analysed once, and from the diagonal D (n). K, when
// factorised, must stay unchanged until the last solve.
class Factors {
 public:
  virtual ~Factors() = default;
  virtual Definiteness factorize(double a, double s, const SymmetricMatrix& k) = 0;
  virtual bool factorize_positive(double a, double s, const SymmetricMatrix& k) = 0;
  virtual Index negative_pivots() const = 0;
  virtual SolveOutcome solve(const Vec& b, Vec& x) = 0;
  // The same for four right-hand sides at once; b, x: n x 4, sized by the caller.
  virtual SolveOutcome solve(const FourColumns& b, FourColumns& x) = 0;
  // Memory [bytes] of the factors alone, known after the analysis. A solve reads it once forwards
  // and once backwards.
  virtual Index bytes() const = 0;
  // Sets the residual that an iterative solve may leave; direct ones leave rounding errors in any
  // case.
  virtual void set_tolerance(double) {}
};

// Makes Factors by CHOLMOD (Chen, Davis, Hager, Rajamanickam, ACM TOMS 35:3, 2008): supernodal LL'
// or simplicial LDL', whichever its flop count favours.
std::unique_ptr<Factors> make_cholmod_factors(const SymmetricMatrix& pattern, Vec diagonal);

// Makes Factors P (a D - s K) P' = L E L' without pivoting, by the multifrontal method (Duff, Reid,
// ACM TOMS 9:3, 1983; Liu, SIAM Review 34:1, 1992). Order and supernodes are those of
// symbolic_factorization.hpp. Throws std::bad_alloc or std::runtime_error when out of memory, here
// only.
std::unique_ptr<Factors> make_multifrontal(const SymmetricMatrix& pattern, Vec diagonal);
// The same for a pattern that is analysed already.
std::unique_ptr<Factors> make_multifrontal(const SymmetricMatrix& pattern, Vec diagonal,
                                           SymbolicFactorization symbolic);

}  // namespace qddot
