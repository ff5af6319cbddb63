#include "integrators/fixed_step.hpp"

#include "integrators/step_times.hpp"

namespace qddot {

FixedStep::FixedStep(const Method& method, const System& system, const Knobs& knobs)
    : Integrator(method, system, knobs), next_{0, Vec(system.size()), Vec(system.size())} {}

Outcome FixedStep::run_to(State& state, double t_stop) {
  const StepTimes times(state.t, t_stop, knobs().step_size);
  if (!times.can_be_taken()) return Outcome::step_too_small;
  for (double i = 1; i <= times.count(); ++i) {
    if (must_stop()) return Outcome::over_budget;
    Outcome outcome = step(state, times.length(i), next_);
    if (outcome == Outcome::reached_end) outcome = judge(next_);
    if (outcome != Outcome::reached_end) return outcome;
    next_.t = times.after(i);
    std::swap(state, next_);
    ++counts().steps;
  }
  return Outcome::reached_end;
}

}  // namespace qddot
