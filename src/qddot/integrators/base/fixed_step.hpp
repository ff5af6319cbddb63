#pragma once

#include <memory>
#include <optional>

#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/integrator.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {

// A method of constant step size h = options.step_size; a derived class gives one step. The steps
// of a run are the same whatever is observed. A state between two steps is the end of a shorter
// step from the first of them. Another object of the same method takes that step, so that this
// one's memory of its steps does not change.
//
// Some methods advance other numbers than q and v. They leave the end of a step incomplete and
// complete it when it is observed.
class FixedStep : public Integrator {
 public:
  FixedStep(const Method& method, const System& system, const Options& options);

 protected:
  // Prepares for one step from `now`, which `run`, of the same class, has reached. The default is
  // start(), which does not know the steps before.
  virtual void resume(const FixedStep& run, const State& now);

  // Call in step() if q and v of its end are incomplete.
  void leave_incomplete() { next_is_complete_ = false; }
  // Whether the state at the start of the step is complete.
  bool is_complete() const { return is_complete_; }

 private:
  // Computes `next`.q and `next`.v (n), a step h [s] after `now`. Any outcome but reached_end ends
  // the run at `now`. If h is not options.step_size, as for a last step and between steps, `now` is
  // complete.
  virtual Outcome step(const State& now, double h, State& next) = 0;
  // Called after each step that is accepted.
  virtual void accepted() {}
  // Completes the end of the last accepted step. If not `may_evaluate`, no forces may be evaluated,
  // because they or the motion have failed; then it is completed as nearly as that allows.
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
