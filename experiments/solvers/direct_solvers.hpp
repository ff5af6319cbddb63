#pragma once

#include <functional>
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

// The rate [operations/s] at which one core multiplies dense matrices in its second cache, by the
// installed BLAS, which uses the widest vectors of the processor. The fastest of all passes in
// `seconds`.
double product_flops(double seconds);

}  // namespace qddot::solvers
