#pragma once

#include "integrators/sundials/support.hpp"

namespace qddot::sundials {

// ARKODE's Newton iteration with a test that uses only the observed rate of convergence. The last
// two corrections give theta = |d_m| / |d_m-1|; the remaining error is about theta/(1 - theta)
// |d_m| (Hairer and Wanner, Solving ODEs II, section IV.8). SUNDIALS' own test remembers the rate
// of earlier solves, lowered by 0.3 each time. If the factors are up to 20 % off in gamma, it stops
// after one iteration on vibrations, with errors of 1e4 and more times the tolerance.
class NewtonTest {
 public:
  NewtonTest(N_Vector y, SUNContext context);

  SUNNonlinearSolver solver() const { return solver_.get(); }
  // To be called after ARKODE has taken the solver and given it a test of its own.
  void attach();

 private:
  static int has_converged(SUNNonlinearSolver solver, N_Vector, N_Vector correction, double,
                           N_Vector weight, void* self);

  NonlinearSolver solver_;
  double last_size_ = 0;
};

}  // namespace qddot::sundials
