#pragma once

#include "qddot/integrators/outcome.hpp"
#include "qddot/model/system.hpp"

namespace qddot {

// How a method moves a state through time, step by step. SystemRun drives it: it asks for steps
// until a time is passed, and then for the state at that time.
class Stepper {
 public:
  Stepper() = default;
  virtual ~Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  // Prepares for steps from `state`; called once a run before everything else.
  virtual void start(const State& state) = 0;
  // Whether the state at t [s] can be shown without a further step.
  virtual bool has_passed(double t) = 0;
  // Takes one step. `t_stop` is the time that is shown next; a step may end beyond it, but not
  // beyond the end of the run. If the outcome is not reached_end, there is no further step.
  virtual Outcome step(double t_stop) = 0;
  // Writes the state at t, which has been passed; it may evaluate forces. If the outcome is not
  // reached_end, it writes the last accepted state if that is after `state`.
  virtual Outcome show(double t, State& state) = 0;
  // Writes the last accepted state if that is after `state`, and evaluates nothing.
  virtual void show_last(State& state) = 0;
  // Adds counts that a library keeps by itself to those of the run; called when the run pauses.
  virtual void collect_counts() {}
};

}  // namespace qddot
