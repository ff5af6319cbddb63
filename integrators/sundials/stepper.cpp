#include "integrators/sundials/stepper.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/integrators/base/creep.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::sundials {
namespace {

// The tolerance of constant steps is for Newton's iteration alone, whose error should be
// negligible.
constexpr double newton_rtol = 1e-10;

}  // namespace

Stepper::Stepper(const Method& method, const System& system, const Options& options,
                 MakeMatrix make_matrix, const System& implicit_part)
    : Integrator(method, system, options),
      implicit_part_(implicit_part),
      context_(make_context()),
      y_(make_matrix == make_klu ? make_stock_vector(system.size(), context())
                                 : make_vector(system.size(), context())),
      atol_(clone(y())),
      per_mass_(system.mass().cwiseInverse()),
      f_(system.size()),
      next_{0, Vec(system.size()), Vec(system.size())} {
  Halves absolute(atol());
  const bool is_given = options.atol > 0;
  absolute.q.setConstant(is_given ? options.atol : rtol() * options.length);
  absolute.v.setConstant(is_given ? options.atol : rtol() * options.speed);
  if (!make_matrix) return;
  k_ = implicit_part.stiffness_pattern();
  matrix_ = make_matrix(implicit_part, context(), options.solver);
  matrix_->time_into(seconds());
}

double Stepper::rtol() const { return has_fixed_step() ? newton_rtol : options().rtol; }

void Stepper::load(const State& state) {
  Halves halves(y());
  halves.q = state.q;
  halves.v = state.v;
  if (has_matrix()) matrix().begin_run();
}

void Stepper::set_counts(const OwnCounts& own) {
  counts().steps = own.steps;
  counts().rejected = own.failed_tests + own.failed_solves;
  counts().factorizations = own.setups;
  counts().newton_iterations = counts().solves = own.iterations;
  if (has_matrix()) counts().indefinite_factorizations = matrix().indefinite();
}

const Vec& Stepper::force_at(const System& part, const Eigen::Map<Vec>& q) {
  force(part, q, f_);
  return f_;
}

bool Stepper::set_rate(const System& part, N_Vector y, N_Vector rate) {
  const Halves at(y);
  Halves change(rate);
  change.q = at.v;
  change.v = per_mass_.cwiseProduct(force_at(part, at.q));
  return std::isfinite(change.v.sum());
}

const SymmetricMatrix& Stepper::stiffness_at(const Eigen::Map<Vec>& q) {
  stiffness(implicit_part_, q, k_);
  return k_;
}

int Stepper::right_hand_side(double, N_Vector y, N_Vector rate, void* user) {
  auto& self = *static_cast<Stepper*>(user);
  return self.guarded([&] { return self.set_rate(self.system(), y, rate); });
}

int Stepper::set_matrix(N_Vector y, bool jok, int* jcur, double gamma) noexcept {
  return guarded([&] {
    if (!jok) stiffness_at(Halves(y).q);
    *jcur = !jok;
    matrix().set_explicit_form(gamma, k_);
    return true;
  });
}

void Stepper::keep_message(int, const char*, const char*, char* message, void* self) {
  try {
    static_cast<Stepper*>(self)->said_ = message;
  } catch (...) {  // no memory for a message: the flag alone is kept
  }
}

void Stepper::begin(const State& state) {
  if (!has_fixed_step()) return;
  now_ = state;
  times_.emplace(state.t, t_end(), options().step_size);
  taken_ = 0;
  beside_ = {};
}

Outcome Stepper::run_to(State& state, double t_stop) {
  parked_ = nullptr;
  is_finite_ = true;
  said_.clear();
  try {
    const Outcome outcome =
        has_fixed_step() ? take_fixed_steps(state, t_stop) : take_chosen_steps(state, t_stop);
    collect_counts();
    counts() += beside_;
    return outcome;
  } catch (...) {
    if (has_fixed_step() && now_.t > state.t) state = now_;
    collect_counts();
    counts() += beside_;
    throw;
  }
}

Outcome Stepper::take_chosen_steps(State& state, double t_stop) {
  Creep creep(state.t);
  set_stop_time(t_stop);
  while (state.t < t_stop) {
    const Outcome outcome = take_one(state, t_stop);
    if (outcome != Outcome::reached_end) return outcome;
    if (creep.is_found(state.t, t_stop)) {
      return failure(Cause::error_test, "creeping", state.t);
    }
  }
  return Outcome::reached_end;
}

Outcome Stepper::take_fixed_steps(State& state, double t_stop) {
  const StepTimes& times = *times_;
  if (!times.can_be_taken()) return Outcome::step_too_small;
  for (const double last = times.last_by(t_stop); taken_ < last;) {
    const double i = taken_ + 1;
    // No stop time is set: ARKODE 6.4.1 halves a first step that ends on one.
    set_step_size(times.length(i));
    const Outcome outcome = take_one(now_, times.after(i));
    if (outcome == Outcome::reached_end) now_.t = times.after(i);
    if (outcome != Outcome::reached_end) {
      if (now_.t > state.t) state = now_;
      return outcome;
    }
    taken_ = i;
  }
  if (!times.is_after(taken_, t_stop)) return step_aside(state, t_stop);
  now_.t = t_stop;
  state = now_;
  return Outcome::reached_end;
}

Outcome Stepper::step_aside(State& state, double t) {
  if (!aside_) {
    auto made = method().make(method(), system(), options());
    aside_.reset(&dynamic_cast<Stepper&>(*made));
    static_cast<void>(made.release());
  }
  aside_->join(*this);
  aside_->start(now_);
  aside_->set_step_size(t - now_.t);
  State there = now_;
  const Outcome outcome = aside_->take_one(there, t);
  aside_->collect_counts();
  if (outcome == Outcome::reached_end) {
    state = there;
  } else {
    if (now_.t > state.t) state = now_;
  }
  aside_->counts().steps = 0;
  beside_ += aside_->counts();
  beside_.force_evaluations = beside_.stiffness_evaluations = 0;  // counted nowhere else
  take_over(*aside_);
  return outcome;
}

Outcome Stepper::take_one(State& state, double t_stop) {
  if (must_stop()) return Outcome::over_budget;
  t_stop_ = t_stop;
  is_finite_ = true;
  double t = state.t;
  const int flag = take_step(t_stop, t);
  if (parked_) std::rethrow_exception(parked_);
  if (has_matrix()) matrix().rethrow();
  if (flag < 0) return failure(flag, state.t);
  const Halves halves(y());
  next_.q = halves.q;
  next_.v = halves.v;
  next_.t = t;
  if (const Outcome outcome = check_step(state, next_); outcome != Outcome::reached_end)
    return outcome;
  std::swap(state, next_);
  note(state);
  note_step();
  return Outcome::reached_end;
}

Cause Stepper::named_cause(int flag, double t) {
  const Cause cause = cause_of(flag);
  const bool has_time =
      t_stop_ - t > 4 * machine_epsilon * std::max(std::abs(t), std::abs(t_stop_));
  if (cause == Cause::end_too_close && has_time) return Cause::accuracy;
  if (is_finite_) return cause;
  if (cause == Cause::convergence || cause == Cause::fast_steps) return Cause::force;
  if (cause == Cause::force && counts().force_evaluations == 1) return Cause::first_force;
  return cause;
}

Outcome Stepper::failure(Cause cause, const std::string& flag, double t) {
  std::ranges::replace(said_, '\n', ' ');
  set_message(fmt::format("{} at t = {:.6g} s: {} ({}{}{})", what_happened(cause), t,
                          what_to_turn(cause, has_fixed_step()), flag, said_.empty() ? "" : ": ",
                          said_));
  return outcome_of(cause);
}

}  // namespace qddot::sundials
