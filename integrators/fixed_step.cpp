#include "integrators/fixed_step.hpp"

#include <cmath>
#include <limits>

namespace qddot {
namespace {

// Beyond |v| = 1e30 m/s nothing of a motion is left, and numbers are still far from overflow.
constexpr double largest_speed_squared = 1e60;

Outcome judge(const System& system, const State& state) {
  const double speed_squared = state.v.squaredNorm();
  if (std::isnan(speed_squared)) return Outcome::not_finite;
  if (!(speed_squared < largest_speed_squared)) return Outcome::diverged;
  return system.holds_at(state.q) ? Outcome::reached_end : Outcome::went_slack;
}

}  // namespace

FixedStep::FixedStep(const Method& method, const System& system, const Knobs& knobs)
    : Integrator(method, system, knobs), next_{0, Vec(system.size()), Vec(system.size())} {}

Outcome FixedStep::run_to(State& state, double t_stop) {
  const double h = knobs().step_size, t_start = state.t;
  // Time is t_start + i h and never a running sum. What the rounding of the two times adds to their
  // distance is no step; a step count that a double cannot hold, or a step that rounding swallows,
  // would never arrive.
  const double slack = 1e-9 + 4 * std::numeric_limits<double>::epsilon() * std::abs(t_stop) / h;
  const double steps = std::max(1.0, std::ceil((t_stop - t_start) / h - slack));
  if (!(h > 0) || !(steps < 1e15) || t_stop - h == t_stop) return Outcome::step_too_small;
  // The last step lands on t_stop; where only rounding parts it from h it is h, so that
  // factorisations for h serve it too.
  const double last = t_stop - (t_start + (steps - 1) * h);
  const double last_h = std::abs(last - h) <= 1e-6 * h ? h : last;

  for (double i = 1; i <= steps; ++i) {
    if (must_stop()) return Outcome::over_budget;
    Outcome outcome = step(state, i < steps ? h : last_h, next_);
    if (outcome == Outcome::reached_end) outcome = judge(system(), next_);
    if (outcome != Outcome::reached_end) return outcome;
    next_.t = i < steps ? t_start + i * h : t_stop;
    std::swap(state, next_);
    ++counts().steps;
  }
  return Outcome::reached_end;
}

}  // namespace qddot
