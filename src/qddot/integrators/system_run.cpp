#include "qddot/integrators/system_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "qddot/integrators/massless_balance.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {
namespace {

// Beyond |v| = 1e30 m/s a run has failed; numbers are still far from overflow.
constexpr double largest_speed_squared = 1e60;
// An eigenvalue of the balance of massless nodes counts as negative this far below zero. The limit
// is at least rtol, as adaptive methods leave the nodes' places as uncertain.
constexpr double balance_tolerance = 1e-6;
// The part of its prediction's error that an implicit step's solve leaves, unless the options allow
// more.
constexpr double solve_tolerance = 1e-4;

// The work of a linear solve and of a factorisation, in forces: less than the least measured.
constexpr std::int64_t forces_a_solve = 2, forces_a_factorization = 20;

}  // namespace

SystemRun::SystemRun(const Method& method, const System& system, const Options& options)
    : method_(method),
      options_(options),
      system_(system, options.timed),
      validity_(system.validity()),
      growth_(system),
      changes_(system, method.order, method.knob == Knob::rtol ? options.rtol : 0),
      stepper_(method.make(*this)) {}

SystemRun::~SystemRun() = default;

void SystemRun::clear(double t_end, std::stop_token stop,
                      std::function<void(const State&)> shown_steps) {
  system_.counts = {};
  system_.seconds = {};
  changes_.clear();
  t_end_ = t_end;
  system_.stay_within(std::numeric_limits<double>::quiet_NaN());
  stop_ = std::move(stop);
  shown_steps_ = std::move(shown_steps);
  shows_steps_ = static_cast<bool>(shown_steps_);
}

void SystemRun::begin(const State& state) {
  message_.clear();
  reached_ = state.t;
  changes_.begin(state);
  system_.stay_in(changes_.phases());
  growth_.stay_in(changes_.broken());
  growth_.start(state);
  piece_end_ = t_end_;
  if (system().has_massless() && system().has_stiffness() &&
      !has_massless_dashpots(system(), state.q)) {
    balance_ = std::make_unique<MasslessBalance>(
        system(), state.q, std::max(balance_tolerance, options_.rtol),
        std::max(solve_tolerance, options_.solve_tolerance));
  }
  stepper_->start(state);
}

void SystemRun::begin_anew(const State& state, double t_end) {
  stay_before(state.t, t_end);
  stepper_->start(state);
}

void SystemRun::stay_before(double t, double t_end) {
  t_end_ = piece_end_ = t_end;
  system_.stay_within(t + (t_end - t) / 2);
}

Outcome SystemRun::run_to(State& state, double t_stop) {
  if (must_stop()) return Outcome::over_budget;
  try {
    if (changes_.are_possible()) {
      const Outcome outcome = take_steps(t_stop, state);
      if (outcome != Outcome::reached_end) stepper_->show_last(state);
      state.phases = changes_.broken();
      stepper_->collect_counts();
      return outcome;
    }
    const Outcome outcome = take_smooth_steps(t_stop);
    const Outcome end = outcome == Outcome::reached_end ? stepper_->show(t_stop, state) : outcome;
    if (outcome != Outcome::reached_end) stepper_->show_last(state);
    stepper_->collect_counts();
    return end;
  } catch (...) {
    stepper_->show_last(state);
    stepper_->collect_counts();
    throw;
  }
}

Outcome SystemRun::take_steps(double t_stop, State& state) {
  for (;;) {
    const bool lands = changes_.is_looking() && changes_.moment() <= t_stop;
    const double t_next = lands ? changes_.moment() : t_stop;
    Outcome outcome = take_smooth_steps(t_next);
    if (outcome == Outcome::reached_end) {
      outcome = stepper_->show(t_next, state);
      // The step from there on decides, which is the same whatever is shown.
      if (outcome == Outcome::chatters) {
        outcome = stepper_->step(t_next);
        if (outcome == Outcome::reached_end) continue;
      }
    }
    if (outcome == Outcome::chatters) {  // a step that passes the end of a phase
      changes_.aim();
      state = changes_.before();
      if (!changes_.is_at_moment()) {
        go_on(state);
      } else if (const Outcome landed = land(state); landed != Outcome::reached_end) {
        return landed;
      }
      continue;
    }
    if (outcome != Outcome::reached_end || !lands) return outcome;
    if (const Outcome landed = land(state); landed != Outcome::reached_end) return landed;
  }
}

Outcome SystemRun::land(State& state) {
  stepper_->collect_counts();
  const auto landing = changes_.land(state);
  if (landing == SpringChanges::Landing::endless) return Outcome::chatters;
  if (landing == SpringChanges::Landing::beyond) {
    state = changes_.before();
  } else if (shows_steps_) {
    show_step(state);
  }
  growth_.stay_in(changes_.broken());
  go_on(state);
  return Outcome::reached_end;
}

void SystemRun::show_step(const State& state) {
  if (!changes_.broken()) return shown_steps_(state);
  State told = state;
  told.phases = changes_.broken();
  shown_steps_(told);
}

void SystemRun::go_on(const State& state) {
  const double end = piece_end_;
  stay_before(state.t, changes_.is_looking() ? changes_.moment() : end);
  piece_end_ = end;
  reached_ = state.t;
  stepper_->start(state);
}

Outcome SystemRun::take_smooth_steps(double t_stop) {
  while (!stepper_->has_passed(t_stop)) {
    const Outcome outcome = must_stop() ? Outcome::over_budget : stepper_->step(t_stop);
    // A step that fails beyond t_stop fails later.
    if (outcome != Outcome::reached_end && !stepper_->has_passed(t_stop)) return outcome;
  }
  return Outcome::reached_end;
}

double SystemRun::work() const {
  const Counts& counts = system_.counts;
  return static_cast<double>(std::max(counts.force_evaluations, counts.steps) +
                             forces_a_solve * counts.solves +
                             forces_a_factorization * counts.factorizations);
}

Outcome SystemRun::check_solve(SolveOutcome solution) {
  if (solution == SolveOutcome::found) return Outcome::reached_end;
  if (solution == SolveOutcome::indefinite) return Outcome::indefinite_matrix;
  set_message(
      "conjugate gradients did not converge; take a shorter step or the multifrontal solver");
  return Outcome::solver_failed;
}

Outcome SystemRun::check_step(const State& from, const State& to) {
  return check_step(from, to, squared_norm(to.v));
}

Outcome SystemRun::check_step(const State& from, const State& to, double squared_speed) {
  if (std::isnan(squared_speed)) return Outcome::not_finite;
  if (!(squared_speed < largest_speed_squared)) {
    // An infinite force makes any speed infinite.
    Vec f(system().size());
    system().force(from, f);
    return f.allFinite() ? Outcome::diverged : Outcome::not_finite;
  }
  if (validity_) {
    if (const auto t = validity_->end_of_validity(from, to)) {
      slack_at_ = *t;
      return Outcome::went_slack;
    }
  }
  if (changes_.are_possible() && to.t > reached() && changes_.passes_end(from, to))
    return Outcome::chatters;
  const auto force_at = [&](const At& at, Vec& f) { system_.force(at, f); };
  const auto stiffness_at = [&](const At& at, SymmetricMatrix& k) { system_.stiffness(at, k); };
  if (balance_ && !balance_->holds(from, to, force_at, stiffness_at)) {
    slack_at_ = to.t;
    return Outcome::went_slack;
  }
  return Outcome::reached_end;
}

Outcome SystemRun::indefinite_at(const At& at) {
  const auto stiffness_at = [&](const At& there, SymmetricMatrix& k) {
    system_.stiffness(there, k);
  };
  if (!balance_ || balance_->are_held_at(at, stiffness_at)) return Outcome::indefinite_matrix;
  slack_at_ = reached();
  return Outcome::went_slack;
}

std::string SystemRun::words_on(Outcome outcome) const {
  if (outcome == Outcome::went_slack && message_.empty()) {
    return fmt::format("at t = {:.6g} s {}", slack_at_, advice(outcome));
  }
  if (outcome == Outcome::newton_failed && balance_) {
    return fmt::format(
        "{}; where that does not help, the springs at a massless node no longer hold it anywhere: "
        "give the node a mass",
        message_.empty() ? advice(outcome) : std::string_view(message_));
  }
  return message_.empty() ? std::string(advice(outcome)) : message_;
}

}  // namespace qddot
