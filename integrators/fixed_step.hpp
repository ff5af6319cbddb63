#pragma once

#include "integrators/integrator.hpp"

namespace qddot {

// A one-step method of constant step size h = knobs.step_size: what remains of it is one step.
class FixedStep : public Integrator {
 public:
  FixedStep(const Method& method, const System& system, const Knobs& knobs);

 private:
  // Computes `next`.q and `next`.v, a step h [s] after `now`; both are sized n. Anything but
  // reached_end ends the run at `now`.
  virtual Outcome step(const State& now, double h, State& next) = 0;

  Outcome run_to(State& state, double t_stop) final;

  State next_;
};

}  // namespace qddot
