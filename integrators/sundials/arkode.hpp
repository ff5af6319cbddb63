#pragma once

#include "integrators/sundials/arkode_stepper.hpp"
#include "integrators/sundials/newton_test.hpp"

namespace qddot::sundials {

using ButcherTable = std::unique_ptr<ARKodeButcherTableMem, FreeBy<ARKodeButcherTable_Free>>;

// The formula of an additive Runge-Kutta method: a table of either kind or both; ARKODE copies
// them.
struct Tables {
  ARKodeButcherTable explicit_table = nullptr, implicit_table = nullptr;
};

// ARKODE's Runge-Kutta methods on y' = (v, M^-1 f(q)). (Hindmarsh et al., ACM TOMS 31:3 (2005)
// 363-396; Reynolds et al., ARXIV 2205.14077.) The settings made here are the same for every linear
// solver; arkode.cpp gives their reasons. Everything else is ARKODE's default.
class Arkode : public ArkodeStepper {
 public:
  // An implicit table is for `implicit_rate`, with Newton's matrix of `implicit_part`; an explicit
  // one is for `explicit_rate`.
  Arkode(SystemRun& run, const Tables& tables, ARKRhsFn explicit_rate, ARKRhsFn implicit_rate,
         MakeMatrix make_matrix, const System& implicit_part);

 private:
  int restart(double t) override;
  static int linear_system(double t, N_Vector y, N_Vector, SUNMatrix, SUNMatrix, int jok, int* jcur,
                           double gamma, void* self, N_Vector, N_Vector, N_Vector);

  ARKRhsFn explicit_rate_, implicit_rate_;
  std::unique_ptr<NewtonTest> newton_;
};

}  // namespace qddot::sundials
