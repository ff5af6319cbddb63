#pragma once

#include "qddot/integrators/sundials/support.hpp"

namespace qddot::sundials {

// ARKODE's Newton iteration with a test that trusts no rate of convergence but the one that it
// sees: with theta = |d_m| / |d_m-1| of the last two corrections, what is left after d_m is about
// theta/(1 - theta) |d_m| (Hairer and Wanner, Solving ODEs II, section IV.8). SUNDIALS' own test
// remembers the rate of earlier solves, lowered by 0.3 each time; on vibrations, where the factors
// are up to 20 % off in gamma, it then stops after one iteration, with errors of 1e4 and more
// times the tolerance.
class NewtonTest {
 public:
  NewtonTest(N_Vector y, SUNContext context);

  SUNNonlinearSolver solver() const { return solver_.get(); }
  // To be called once the solver is ARKODE's, which gives it a test of its own.
  void attach();

 private:
  static int has_converged(SUNNonlinearSolver solver, N_Vector, N_Vector correction, double,
                           N_Vector weight, void* self);

  NonlinearSolver solver_;
  double last_size_ = 0;
};

}  // namespace qddot::sundials
