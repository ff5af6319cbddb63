#pragma once

#include <optional>

#include "integrators/sundials/library.hpp"
#include "qddot/integrators/base/renewed_bound.hpp"

namespace qddot::sundials {

// The run of a stepper of ARKODE, whichever its formulas: its memory, steps and counts. A derived
// class makes the memory, and starts it from a state.
class ArkodeStepper : public Library {
 public:
  void set_stop_time(double t_stop) override;

 protected:
  ArkodeStepper(SystemRun& run, MakeMatrix make_matrix, const System& implicit_part);

  // Keeps the memory of a stepper, to be called once.
  void keep(void* memory);
  // Gives it the tolerances, for steps that it chooses and for Newton's iteration.
  void set_tolerances();
  void* memory() const { return memory_.get(); }
  // Holds all steps to h <= y/w_max, with Gershgorin's bound of the largest frequency of a part of
  // the system, renewed every few steps. Call in the constructor.
  void limit_steps(const System& part, double y);
  void start(const State& state) override;
  // Starts the memory anew at t [s] and y.
  virtual int restart(double t) = 0;
  OwnCounts own_counts() const override;

 private:
  void set_step_size(double h) override;
  int take_step(double t_stop, double& t) override;
  Cause cause_of(int flag) const override;
  std::string flag_name(int flag) const override;
  static int stable_step(N_Vector y, double t, double* h, void* self);

  struct Limit {
    const System& part;
    double y;
    Vec q;
    RenewedBound w_max;
    std::int64_t calls = 0;
  };
  std::optional<Limit> limit_;
  std::unique_ptr<void, FreeMemoryBy<ARKodeFree>> memory_;
};

// The cause of a flag, which all ARKODE steppers share.
Cause cause_of_arkode(int flag);

}  // namespace qddot::sundials
