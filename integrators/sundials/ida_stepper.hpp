#pragma once

#include "integrators/sundials/library.hpp"
#include "integrators/sundials/orders.hpp"

namespace qddot::sundials {

// The run of IDA, whichever its residual: its memory, steps and counts. A derived class has the
// residual and its Jacobian, and starts IDA from a state.
class IdaStepper : public Library {
 public:
  void set_stop_time(double t_stop) override;
  void note_step() override;

 protected:
  IdaStepper(SystemRun& run, MakeMatrix make_matrix);
  // For a vector of that length (see Library).
  IdaStepper(SystemRun& run, Index length);

  // What IDA is made of, to be called once, with the tolerances as they are in atol() then.
  struct Equations {
    IDAResFn residual;
    IDALsJacFn jacobian;
    SUNLinearSolver solver;
    SUNMatrix matrix;
  };
  void keep(const Equations& equations);
  void* ida() const { return memory_.get(); }
  N_Vector rate() const { return rate_.get(); }  // y'

  // Forgets all counts and orders, for a new run.
  void forget();
  // Starts IDA at t [s], y and y'. The second keeps the counts so far.
  void start_ida(double t);
  void restart_ida(double t);
  OwnCounts own_counts() const override;
  Cause cause_of(int flag) const override;
  std::string flag_name(int flag) const override;

 private:
  Orders orders_;
  Vector rate_;
  OwnCounts earlier_;  // before the last start of IDA, which clears its counts
  std::unique_ptr<void, FreeMemoryBy<IDAFree>> memory_;
};

}  // namespace qddot::sundials
