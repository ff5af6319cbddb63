#pragma once

#include <memory>
#include <optional>

#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/integrator.hpp"

namespace qddot {

// A one-step method of constant step size h = options.step_size: what remains of it is one step.
// The steps of a run are the same whatever is observed. A state between two of them is the end of a
// shorter step from the first, taken by another object of the same method, so that nothing that
// this one remembers of its steps changes.
class FixedStep : public Integrator {
 public:
  FixedStep(const Method& method, const System& system, const Options& options);

 protected:
  // Prepares for one step from `now`, to which `run`, of the same class, has come. start() is
  // enough for that, but does not know the steps before.
  virtual void resume(const FixedStep& run, const State& now);

 private:
  // Computes `next`.q and `next`.v, a step h [s] after `now`; both are sized n. Anything but
  // reached_end ends the run at `now`. Methods that override complete() may leave in `next`.v what
  // is a velocity near that time only.
  virtual Outcome step(const State& now, double h, State& next) = 0;
  // Computes the velocity of a state that the last step, or the one before if that was not
  // accepted, led to: called before anybody looks at it. Without `may_evaluate` forces are not to
  // be evaluated, for that has failed or the motion has.
  virtual void complete(State&, [[maybe_unused]] bool may_evaluate) {}

  void begin(const State& state) final;
  Outcome run_to(State& state, double t_stop) final;
  Outcome take_steps(double t_stop);
  Outcome step_aside(double t);

  State now_, next_;
  std::optional<StepTimes> times_;
  double taken_ = 0;  // steps
  std::unique_ptr<FixedStep> aside_;
};

}  // namespace qddot
