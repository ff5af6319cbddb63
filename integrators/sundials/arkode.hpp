#pragma once

#include <optional>

#include <arkode/arkode_arkstep.h>

#include "qddot/integrators/base/renewed_bound.hpp"
#include "qddot/integrators/sundials/newton_test.hpp"
#include "qddot/integrators/sundials/stepper.hpp"

namespace qddot::sundials {

using ButcherTable = std::unique_ptr<ARKodeButcherTableMem, FreeBy<ARKodeButcherTable_Free>>;

// The formula of an additive Runge-Kutta method: a table of either kind or both, which ARKODE
// copies.
struct Tables {
  ARKodeButcherTable explicit_table = nullptr, implicit_table = nullptr;
};

// ARKODE's Runge-Kutta methods on y' = (v, M^-1 f(q)). (Hindmarsh et al., ACM TOMS 31:3 (2005)
// 363-396; Reynolds et al., ARXIV 2205.14077.) What is set here is the same for every linear solver
// and said in arkode.cpp with its reason; everything else is ARKODE's default.
class Arkode : public Stepper {
 public:
  // With an implicit table, `implicit_rate` is what it is for, and Newton's matrix is that of
  // `implicit_part`; with an explicit one, `explicit_rate`.
  Arkode(const Method& method, const System& system, const Options& options, const Tables& tables,
         ARKRhsFn explicit_rate, ARKRhsFn implicit_rate, MakeMatrix make_matrix,
         const System& implicit_part);

 protected:
  void* memory() const { return memory_.get(); }
  // Holds all steps to h <= y/w_max, with Gershgorin's bound of the largest frequency of a part of
  // the system, taken anew every few steps. For use in the constructor.
  void limit_steps(const System& part, double y);
  void start(const State& state) override;
  void collect_counts() override;

 private:
  void set_stop_time(double t_stop) override;
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

// ARKODE's flags are the same for all of its steppers.
Cause cause_of_arkode(int flag);

}  // namespace qddot::sundials
