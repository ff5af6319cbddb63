#pragma once

#include <optional>

#include <arkode/arkode_arkstep.h>

#include "integrators/sundials/library.hpp"
#include "integrators/sundials/newton_test.hpp"
#include "qddot/integrators/base/renewed_bound.hpp"

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
class Arkode : public Library {
 public:
  // An implicit table is for `implicit_rate`, with Newton's matrix of `implicit_part`; an explicit
  // one is for `explicit_rate`.
  Arkode(SystemRun& run, const Tables& tables, ARKRhsFn explicit_rate, ARKRhsFn implicit_rate,
         MakeMatrix make_matrix, const System& implicit_part);

  void set_stop_time(double t_stop) override;

 protected:
  void* memory() const { return memory_.get(); }
  // Holds all steps to h <= y/w_max, with Gershgorin's bound of the largest frequency of a part of
  // the system, renewed every few steps. Call in the constructor.
  void limit_steps(const System& part, double y);
  void start(const State& state) override;
  OwnCounts own_counts() const override;

 private:
  void set_step_size(double h) override;
  int take_step(double t_stop, double& t) override;
  Cause cause_of(int flag) const override;
  std::string flag_name(int flag) const override;

  static int linear_system(double t, N_Vector y, N_Vector, SUNMatrix, SUNMatrix, int jok, int* jcur,
                           double gamma, void* self, N_Vector, N_Vector, N_Vector);
  static int stable_step(N_Vector y, double t, double* h, void* self);

  struct Limit {
    const System& part;
    double y;
    Vec q;
    RenewedBound w_max;
    std::int64_t calls = 0;
  };
  ARKRhsFn explicit_rate_, implicit_rate_;
  std::unique_ptr<NewtonTest> newton_;
  std::optional<Limit> limit_;
  std::unique_ptr<void, FreeMemoryBy<ARKStepFree>> memory_;
};

// The cause of a flag, which all ARKODE steppers share.
Cause cause_of_arkode(int flag);

}  // namespace qddot::sundials
