#pragma once

#include <memory>
#include <optional>

#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/integrator.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {

// A method of constant step size h = options.step_size: what remains of it is one step. The steps
// of a run are the same whatever is observed. A state between two of them is the end of a shorter
// step from the first, taken by another object of the same method, so that nothing that this one
// remembers of its steps changes.
//
// Some methods go from step to step by other numbers than q and v. They leave the end of a step
// incomplete and complete it where somebody looks at it.
class FixedStep : public Integrator {
 public:
  FixedStep(const Method& method, const System& system, const Options& options);

 protected:
  // Prepares for one step from `now`, to which `run`, of the same class, has come. start() is
  // enough for that, but does not know the steps before.
  virtual void resume(const FixedStep& run, const State& now);

  // To be called in step(): q and v of its end are not yet what they are to be.
  void leave_incomplete() { next_is_complete_ = false; }
  // Whether those of the state that a step begins at are.
  bool is_complete() const { return is_complete_; }

 private:
  // Computes `next`.q and `next`.v, a step h [s] after `now`; both are sized n. Anything but
  // reached_end ends the run at `now`. Where h is not options.step_size, which is so for a last
  // step and between steps, `now` is complete.
  virtual Outcome step(const State& now, double h, State& next) = 0;
  // Called after each step that is accepted.
  virtual void accepted() {}
  // Makes of the incomplete end of the last step that was accepted what it is to be. Without
  // `may_evaluate` forces must not be evaluated, for that, or the motion, has failed; then it is to
  // be as near as they let it.
  virtual void complete(State&, [[maybe_unused]] bool may_evaluate) {}
  // |v|^2 at the incomplete end of the last step, accepted or not.
  virtual double squared_speed(const State& next) { return squared_norm(next.v); }

  void begin(const State& state) final;
  Outcome run_to(State& state, double t_stop) final;
  Outcome take_steps(double t_stop);
  Outcome step_aside(double t);
  void complete_now(bool may_evaluate);

  State now_, next_;
  bool is_complete_ = true, next_is_complete_ = true;
  std::optional<StepTimes> times_;
  double taken_ = 0;  // steps
  std::unique_ptr<FixedStep> aside_;
};

}  // namespace qddot
