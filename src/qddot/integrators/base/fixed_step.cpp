#include "qddot/integrators/base/fixed_step.hpp"

#include "qddot/integrators/method.hpp"

namespace qddot {

FixedStep::FixedStep(const Method& method, const System& system, const Options& options)
    : Integrator(method, system, options),
      now_{0, Vec(system.size()), Vec(system.size())},
      next_{0, Vec(system.size()), Vec(system.size())} {}

void FixedStep::resume(const FixedStep&, const State& now) { start(now); }

void FixedStep::begin(const State& state) {
  now_ = state;
  is_complete_ = true;
  times_.emplace(state.t, t_end(), options().step_size);
  taken_ = 0;
}

void FixedStep::complete_now(bool may_evaluate) {
  if (is_complete_) return;
  complete(now_, may_evaluate);
  is_complete_ = true;
}

Outcome FixedStep::run_to(State& state, double t_stop) {
  Outcome outcome = Outcome::solver_failed;
  const auto show_last = [&](bool may_evaluate) {
    if (now_.t <= state.t) return;
    complete_now(may_evaluate);
    state = now_;
  };
  try {
    outcome = take_steps(t_stop);
    const bool is_there = outcome == Outcome::reached_end && times_->is_after(taken_, t_stop);
    if (is_there) now_.t = t_stop;
    if (is_there || outcome != Outcome::reached_end) {
      show_last(is_there);
      return outcome;
    }
    outcome = step_aside(t_stop);
  } catch (...) {
    show_last(false);
    throw;
  }
  if (outcome == Outcome::reached_end) {
    state = next_;
  } else {
    show_last(false);
  }
  return outcome;
}

// Takes all steps that end at t_stop or before.
Outcome FixedStep::take_steps(double t_stop) {
  const StepTimes& times = *times_;
  if (!times.can_be_taken()) return Outcome::step_too_small;
  for (const double last = times.last_by(t_stop); taken_ < last;) {
    if (must_stop()) return Outcome::over_budget;
    const double i = taken_ + 1, h = times.length(i);
    if (h != options().step_size) complete_now(true);
    next_is_complete_ = true;
    Outcome outcome = step(now_, h, next_);
    next_.t = times.after(i);
    if (outcome != Outcome::reached_end) return outcome;
    const bool looks_closely = checks_velocities() && !next_is_complete_;
    if (looks_closely) {
      accepted();
      complete(next_, true);
      next_is_complete_ = true;
    }
    const double squared_speed_there =
        next_is_complete_ ? squared_norm(next_.v) : squared_speed(next_);
    outcome = check_step(now_, next_, squared_speed_there);
    if (outcome != Outcome::reached_end) return outcome;
    if (!looks_closely) accepted();
    std::swap(now_, next_);
    is_complete_ = next_is_complete_;
    taken_ = i;
    ++counts().steps;
    see_speed(squared_speed_there);
    if (looks_next()) complete_now(true);
    note(now_);
  }
  return Outcome::reached_end;
}

// Steps from the last step to a time before the next one, into next_.
Outcome FixedStep::step_aside(double t) {
  complete_now(true);
  if (!aside_) {
    auto made = method().make(method(), system(), options());
    aside_.reset(&dynamic_cast<FixedStep&>(*made));
    static_cast<void>(made.release());
  }
  aside_->join(*this);
  aside_->resume(*this, now_);
  aside_->is_complete_ = aside_->next_is_complete_ = true;
  Outcome outcome = aside_->step(now_, t - now_.t, next_);
  next_.t = t;
  if (outcome == Outcome::reached_end && !aside_->next_is_complete_) {
    aside_->accepted();
    aside_->complete(next_, true);
  }
  take_over(*aside_);
  if (outcome == Outcome::reached_end) outcome = check_step(now_, next_);
  return outcome;
}

}  // namespace qddot
