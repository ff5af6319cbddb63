// The last phase of a search: runs that may be faster than its answer.
#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

// A run is made only if it is expected to take less than this fraction of the answer's time.
constexpr double clearly_faster = 0.92;
// The part of the accuracy that a run aims at.
constexpr double aim = 0.6;

// The time [s] for runs that may be faster than the answer. It is unnoticed by users or, for a long
// answer, a small part of the answer's time.
double seconds_of_race(const Trial& answer) {
  constexpr double unnoticed = 0.02, part = 0.25;
  return std::max(unnoticed, part * answer.seconds);
}

}  // namespace

// The fastest run, not made yet, that is expected to have the error in less than `seconds`.
std::optional<Candidate> Search::promised(double error, double seconds) const {
  for (const Candidate& c : forecast_->candidates(error)) {
    if (c.seconds > seconds) break;
    if (!was_tried(*c.method, c.value)) return c;
  }
  return {};
}

// The first run of a method that has no forecast without one.
std::optional<Candidate> Search::untried(const Trial& answer, double accuracy) const {
  const System& system = stage_.model().system();
  for (const Method& method : methods()) {
    if (is_forecast_by_frequency(method) || method.order < 2 || !applies_to(method, system) ||
        method.family == Family::sundials || method.asks(Need::laplacian))
      continue;
    if (system.has_massless() && !method.is(Trait::accepts_massless)) continue;
    if (stage_.of() == AccuracyOf::energy && method.is(Trait::implicit)) continue;
    if (std::ranges::find(trials_, &method, &Trial::method) != trials_.end()) continue;
    // Forces that the run evaluates at least: a step of order p takes about p of them, and an
    // implicit step as long as twenty.
    constexpr double of_implicit_step = 20;
    double value = std::clamp(accuracy, 1e-13, 1e-2), forces = 0;
    if (method.knob == Knob::step_size) {
      // Steps that resolve the motion's own frequency of order 2, or the soft forces.
      const double own = method.asks(Need::split_forces)
                             ? resolved_frequency(method, system, stage_.model().initial().q)
                             : forecast_->own().at(2);
      double steps = std::max(8.0, std::ceil(stage_.until() * own));
      if (has_linear_step(method))
        steps = std::max(
            steps, std::ceil(stage_.until() / forecast_->step_by_frequency(method, accuracy)));
      value = stage_.until() / steps;
      forces = steps * (method.is(Trait::implicit) ? of_implicit_step : 1);
    } else {
      // Steps of order p leave the accuracy if h w_p is its p-th root.
      double steps = stage_.until() * forecast_->own().at(method.order) *
                     std::pow(accuracy, -1.0 / method.order);
      if (method.is(Trait::bounds_steps))
        steps = std::max(steps, stage_.until() * forecast_->w_motion());
      forces = steps * (method.is(Trait::implicit) ? of_implicit_step : method.order);
    }
    if (forces > static_cast<double>(answer.summary.counts.force_evaluations)) continue;
    return Candidate{&method, value, 0, 0};
  }
  return {};
}

const Trial* Search::race(const Trial* answer, double accuracy) {
  if (answer->method->order == 0 || judges_.empty()) return answer;
  const double end = seconds_since(begin_) + seconds_of_race(*answer);
  if (!may_forecast(*answer)) return answer;
  learn();
  while (seconds_left() > 0) {
    const double left = end - seconds_since(begin_);
    if (left <= 0) break;
    std::optional<Candidate> next =
        promised(aim * accuracy, std::min(left, clearly_faster * answer->seconds));
    if (!next) next = untried(*answer, accuracy);
    if (!next) break;
    const Trial& trial = run(*next->method, next->value,
                             {.seconds = std::min(left, clearly_faster * answer->seconds + 1e-5)});
    learn();
    if (trial.seconds < answer->seconds && is_known(trial, accuracy)) answer = &trial;
  }
  return answer;
}

}  // namespace qddot::inline measure
