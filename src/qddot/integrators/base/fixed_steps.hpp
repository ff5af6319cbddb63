#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "qddot/integrators/base/formula.hpp"
#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/method.hpp"

namespace qddot {

// Steps of constant size h = options.step_size by a formula F (see Formula). The steps of a run are
// the same whatever is observed.
template <class F>
class FixedSteps final : public Stepper {
  using X = typename F::X;
  static constexpr bool is_state = std::is_same_v<X, State>;

 public:
  // `arguments`: those that the formula's constructor takes beside the run.
  template <class... Arguments>
  explicit FixedSteps(SystemRun& run, const Arguments&... arguments)
      : run_(run), formula_(run, arguments...) {}

  void start(const State& state) override {
    times_.emplace(state.t, run_.t_end(), run_.options().step_size);
    taken_ = 0;
    t_stop_ = std::numeric_limits<double>::quiet_NaN();
    formula_.begin(state, *x_);
    x_->t = state.t;
    *next_ = *x_;
    if constexpr (!is_state) shown_ = state;
    if (!is_state && run_.checks_velocities()) shown_next_ = state;
  }

  bool has_passed(double t) override {
    if (t != t_stop_) {
      t_stop_ = t;
      // Steps that cannot be taken fail before anything is shown.
      last_ = times_->can_be_taken() ? times_->last_by(t) : std::numeric_limits<double>::infinity();
    }
    return taken_ >= last_;
  }

  Outcome step(double) override {
    if (!times_->can_be_taken()) return Outcome::step_too_small;
    const double i = taken_ + 1, t = times_->after(i);
    next_->t = t;
    Outcome outcome = formula_.step(*x_, times_->length(i), *next_);
    next_->t = t;
    if (outcome != Outcome::reached_end) return outcome;
    double squared_speed = 0;
    if (!is_state && run_.checks_velocities()) {
      show(*next_, true, shown_next_);
      squared_speed = squared_norm(shown_next_.v);
      outcome = run_.check_step(shown_, shown_next_, squared_speed);
      std::swap(shown_, shown_next_);
    } else {
      squared_speed = formula_.squared_speed(*next_);
      outcome = run_.check_step(*x_, *next_, squared_speed);
    }
    if (outcome != Outcome::reached_end) return outcome;
    std::swap(x_, next_);
    taken_ = i;
    ++run_.counts().steps;
    run_.see_speed(squared_speed);
    run_.note(run_.looks_next() ? shown(true) : *x_);
    return Outcome::reached_end;
  }

  Outcome show(double t, State& state) override {
    if (!times_->is_after(taken_, t)) return step_aside(t, state);
    x_->t = t;
    state = shown(true);
    return Outcome::reached_end;
  }

  void show_last(State& state) override {
    if (x_->t > state.t) state = shown(false);
  }

  void collect_counts() override {
    if constexpr (requires { formula_.collect_counts(); }) {
      formula_.collect_counts();
      if (aside_) aside_->collect_counts();
    }
  }

 private:
  void show(X& x, bool may_evaluate, State& state) {
    if constexpr (!is_state) {
      state.t = x.t;
      state.work = x.work;
      formula_.show(x, may_evaluate, state);
    }
  }
  const State& shown(bool may_evaluate) {
    if constexpr (is_state) {
      return *x_;
    } else {
      show(*x_, may_evaluate, shown_);
      return shown_;
    }
  }

  // Steps from the last step to a time before the next one.
  Outcome step_aside(double t, State& state) {
    const State& now = shown(true);
    if (!aside_) {
      auto made = run_.method().make(run_);
      aside_.reset(&dynamic_cast<FixedSteps&>(*made));
      static_cast<void>(made.release());
    }
    const Outcome outcome = aside_->step_once(formula_, *x_, now, t);
    if (outcome == Outcome::reached_end) {
      state = aside_->shown_or_next();
    } else {
      show_last(state);
    }
    return outcome;
  }

  // One step to t by this object, from an x of `formula`, whose state is `now`.
  Outcome step_once(const F& formula, const X& x, const State& now, double t) {
    if constexpr (requires { formula_.resume(formula, x, *x_); }) {
      formula_.resume(formula, x, *x_);
    } else {
      formula_.begin(now, *x_);
    }
    x_->t = now.t;
    *next_ = *x_;
    next_->t = t;
    Outcome outcome = formula_.step(*x_, t - now.t, *next_);
    next_->t = t;
    if (outcome != Outcome::reached_end) return outcome;
    if constexpr (!is_state) {
      shown_next_ = now;
      show(*next_, true, shown_next_);
    }
    return run_.check_step(now, shown_or_next());
  }
  const State& shown_or_next() const {
    if constexpr (is_state) {
      return *next_;
    } else {
      return shown_next_;
    }
  }

  SystemRun& run_;
  F formula_;
  X steps_[2];
  X *x_ = &steps_[0], *next_ = &steps_[1];  // the last step's end, and the next one's
  State shown_, shown_next_;                // the states of both, where they are not X itself
  std::optional<StepTimes> times_;
  double taken_ = 0, last_ = 0;  // steps, and those up to t_stop_
  double t_stop_ = 0;            // [s]
  std::unique_ptr<FixedSteps> aside_;
};

// Makes the stepper of a method from a formula, or from a Stepper; for Method::make.
template <class T>
std::unique_ptr<Stepper> create(SystemRun& run) {
  if constexpr (std::is_base_of_v<Stepper, T>) {
    return std::make_unique<T>(run);
  } else {
    return std::make_unique<FixedSteps<T>>(run);
  }
}

}  // namespace qddot
