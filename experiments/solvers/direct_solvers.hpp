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

  // What one factorisation takes, additions and multiplications counted one by one, and the bytes
  // of the factors that a solve reads (twice, where they are L and its transpose); 0 where the
  // solver does not tell.
  double flops = 0, bytes = 0;
};

struct DirectSolverKind {
  std::string name;
  // Analyses the system's pattern. The system must outlive the solver.
  std::function<std::unique_ptr<DirectSolver>(const System&)> make;
};

// multifrontal and cholmod (see effective_mass.hpp); eigen: its simplicial LDL' in the order of
// AMD; klu: the 2n x 2n matrix of the first-order form, factorised with the pivots of the first
// time, as SUNDIALS' users have it.
const std::vector<DirectSolverKind>& direct_solvers();

}  // namespace qddot::solvers
