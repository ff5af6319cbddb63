#include "qddot/integrators/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "qddot/integrators/massless_balance.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {
namespace {

// Beyond |v| = 1e30 m/s a run has failed; numbers are still far from overflow.
constexpr double largest_speed_squared = 1e60;
// Below this, h^2 has lost digits.
constexpr double shortest_squared = 1e-290;
// An eigenvalue of the balance of massless nodes counts as negative this far below zero. The limit
// is at least rtol, as adaptive methods leave the nodes' places as uncertain.
constexpr double balance_tolerance = 1e-6;
// The part of its prediction's error that an implicit step's solve leaves, unless the options allow
// more.
constexpr double solve_tolerance = 1e-4;

// The work of a linear solve and of a factorisation, in forces: less than the least measured.
constexpr std::int64_t forces_a_solve = 2, forces_a_factorization = 20;

// The names of outcomes and the advice on them, in the order of Outcome.
struct OutcomeWords {
  std::string_view name, advice;
};
constexpr OutcomeWords outcomes[] = {
    {"reached_end", ""},
    {"diverged", "the motion grew without bound: take a smaller step or an implicit method"},
    {"newton_failed", "the nonlinear solve of a step did not converge: take a smaller step"},
    {"indefinite_matrix",
     "M - h^2 K is not positive definite, as compressed springs make it: take a smaller step or an "
     "explicit method"},
    {"step_too_small",
     "the step is too small for the time to advance: take a larger step or tolerance, or an "
     "earlier end"},
    {"singular_mass",
     "a massless node has no acceleration: give it a mass or take a method that accepts massless "
     "nodes"},
    {"not_finite",
     "a force or velocity is not a finite number: take a smaller step, or look for extreme values "
     "in the scene"},
    {"solver_failed", "the solver gave up"},
    {"over_budget", "the run was stopped because its time was up"},
    {"stiffness_varies",
     "K changes with the positions, and this method is for constant K: take another one"},
    {"went_slack",
     "springs at a massless node came under compression, where they fold up in no time: give the "
     "node a mass; or on a scene of one dimension, where nothing folds up, keep it (--no-reduce "
     "massless) and take a method that accepts massless nodes"},
    {"no_stiff_set",
     "the scene names no stiff springs, whose forces this method takes apart: give it stiff_above, "
     "or take another method"},
    {"no_laplacian",
     "the system has no matrix that stands for its stiffness everywhere, as springs have: take "
     "another method"},
    {"no_stiffness",
     "the system computes no stiffness matrix K, which this method needs: give it "
     "stiffness_pattern() and stiffness(), or take an explicit method"},
    {"no_discrete_gradient",
     "the system computes no discrete gradient of its energy, which this method needs: take "
     "another method"},
    {"unknown", ""}};  // any other number
static_assert(std::size(outcomes) == static_cast<std::size_t>(Outcome::no_discrete_gradient) + 2);

const OutcomeWords& words_of(Outcome outcome) {
  return outcomes[std::min(static_cast<std::size_t>(outcome), std::size(outcomes) - 1)];
}

// Throws std::invalid_argument unless a run with these arguments is allowed. Numbers that are not
// finite make the run fail instead.
void check_arguments(const System& system, const State& state, double t_end,
                     const Observer& observer) {
  const auto check_size = [&](const char* which, const Vec& x) {
    if (x.size() == system.size()) return;
    throw std::invalid_argument(
        fmt::format("advance: {} has {} entries, and the system has {} unknowns", which, x.size(),
                    system.size()));
  };
  check_size("q", state.q);
  check_size("v", state.v);
  if (std::isfinite(t_end) && t_end < state.t) {
    throw std::invalid_argument(
        fmt::format("advance: the end t = {:g} s is before the start t = {:g} s", t_end, state.t));
  }
  if (!std::isfinite(state.t) || !std::isfinite(t_end)) return;
  double last = state.t;
  for (const double t : observer.times) {
    if (t >= last && t <= t_end) {
      last = t;
      continue;
    }
    throw std::invalid_argument(
        fmt::format("advance: the observer's time {:g} s is not allowed; its times ascend from "
                    "{:g} s to {:g} s",
                    t, state.t, t_end));
  }
  if (!observer.times.empty() && !observer.see)
    throw std::invalid_argument("advance: the observer has times, but no function to call");
}

}  // namespace

std::string_view name(Outcome outcome) { return words_of(outcome).name; }
std::string_view advice(Outcome outcome) { return words_of(outcome).advice; }

Counts& Counts::operator+=(const Counts& more) {
  steps += more.steps;
  rejected += more.rejected;
  force_evaluations += more.force_evaluations;
  stiffness_evaluations += more.stiffness_evaluations;
  factorizations += more.factorizations;
  solves += more.solves;
  newton_iterations += more.newton_iterations;
  indefinite_factorizations += more.indefinite_factorizations;
  order_sum += more.order_sum;
  order_reductions += more.order_reductions;
  stability_limited_steps += more.stability_limited_steps;
  return *this;
}

Seconds& Seconds::operator+=(const Seconds& more) {
  force += more.force;
  stiffness += more.stiffness;
  factorization += more.factorization;
  solve += more.solve;
  return *this;
}

Integrator::Integrator(const Method& method, const System& system, const Options& options)
    : method_(method),
      system_(system),
      split_stiffness_(capability<SplitStiffness>(system)),
      discrete_gradient_(capability<DiscreteGradient>(system)),
      validity_(capability<Validity>(system)),
      options_(options),
      growth_(system) {}

Integrator::~Integrator() = default;

Summary Integrator::advance(State& state, double t_end, const Observer& observer,
                            std::stop_token stop) {
  counts_ = {};
  seconds_ = {};
  message_.clear();
  failed_step_ = 0;
  stop_ = std::move(stop);
  shown_steps_ = observer.step;
  shows_steps_ = static_cast<bool>(shown_steps_);
  has_begun_ = false;
  Outcome outcome = Outcome::reached_end;
  EnergyChange energy;
  check_arguments(system_, state, t_end, observer);
  try {
    outcome = run(state, t_end, observer);
  } catch (const std::bad_alloc&) {
    outcome = Outcome::solver_failed;
    set_message(
        "memory ran out: take a scene of fewer nodes, or a method or solver that factorises "
        "nothing (verlet; conjugate gradients)");
  } catch (const SolverFailure& error) {
    outcome = Outcome::solver_failed;
    set_message(error.what());
  }
  if (has_begun_) energy = energy_change(state);
  Summary summary{outcome,       state.t, counts_,     seconds_,     {},
                  energy.growth, 0,       energy.lost, energy.loss()};
  if (outcome == Outcome::reached_end) return summary;
  summary.message = words_on(outcome);
  summary.failed_step = failed_step_ > 0 ? failed_step_ : counts_.steps + 1;
  return summary;
}

double Integrator::work() const {
  return static_cast<double>(std::max(counts_.force_evaluations, counts_.steps) +
                             forces_a_solve * counts_.solves +
                             forces_a_factorization * counts_.factorizations);
}

Outcome Integrator::check_solve(SolveOutcome solution) {
  if (solution == SolveOutcome::found) return Outcome::reached_end;
  if (solution == SolveOutcome::indefinite) return Outcome::indefinite_matrix;
  set_message(
      "conjugate gradients did not converge; take a shorter step or the multifrontal solver");
  return Outcome::solver_failed;
}

Outcome Integrator::check_step(const State& from, const State& to) {
  return check_step(from, to, squared_norm(to.v));
}

Outcome Integrator::check_step(const State& from, const State& to, double squared_speed) {
  if (std::isnan(squared_speed)) return Outcome::not_finite;
  if (!(squared_speed < largest_speed_squared)) {
    // An infinite force makes any speed infinite.
    Vec f(system_.size());
    system_.force(from.q, f);
    return f.allFinite() ? Outcome::diverged : Outcome::not_finite;
  }
  if (validity_) {
    if (const auto t = validity_->end_of_validity(from, to)) {
      slack_at_ = *t;
      return Outcome::went_slack;
    }
  }
  const auto force_at = [&](const Vec& q, Vec& f) { force(q, f); };
  const auto stiffness_at = [&](const Vec& q, SymmetricMatrix& k) { stiffness(q, k); };
  if (balance_ && !balance_->holds(from, to, force_at, stiffness_at)) {
    slack_at_ = to.t;
    return Outcome::went_slack;
  }
  return Outcome::reached_end;
}

Outcome Integrator::indefinite_at(const Vec& q) {
  const auto stiffness_at = [&](const Vec& at, SymmetricMatrix& k) { stiffness(at, k); };
  if (!balance_ || balance_->are_held_at(q, stiffness_at)) return Outcome::indefinite_matrix;
  slack_at_ = reached();
  return Outcome::went_slack;
}

std::string Integrator::words_on(Outcome outcome) const {
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

void Integrator::join(const Integrator& run) {
  message_.clear();
  stop_ = run.stop_;
  t_end_ = run.t_end_;
}

void Integrator::take_over(Integrator& other) {
  message_ = other.message_;
  slack_at_ = other.slack_at_;
  counts_ += other.counts_;
  seconds_ += other.seconds_;
  other.counts_ = {};
  other.seconds_ = {};
}

void Integrator::set_out(const State& state) {
  reached_ = state.t;
  if (blocks_of(system_).empty()) {  // blocks check their own massless nodes
    growth_.start(state);
    if (system_.has_massless() && system_.has_stiffness()) {
      balance_ = std::make_unique<MasslessBalance>(
          system_, state.q, std::max(balance_tolerance, options_.rtol),
          std::max(solve_tolerance, options_.solve_tolerance));
    }
  }
  begin(state);
  start(state);
}

Outcome Integrator::run(State& state, double t_end, const Observer& observer) {
  if (!std::isfinite(state.t) || !state.q.allFinite() || !state.v.allFinite() ||
      !std::isfinite(t_end)) {
    set_message("the start is not finite");
    return Outcome::not_finite;
  }
  if (system_.has_massless() && !method_.is(Trait::accepts_massless)) return Outcome::singular_mass;
  if (const auto why = misfit(method_, system_)) return *why;
  if (const double whole = t_end - state.t; whole > 0 && !(whole * whole > shortest_squared)) {
    set_message(fmt::format(
        "the {:g} s to run are too short for their square to be a number: ask for a later end",
        whole));
    return Outcome::step_too_small;
  }

  const bool moves = system_.size() > 0 && t_end > state.t;
  const auto go_to = [&](double t) {
    const Outcome outcome = moves && t > state.t ? run_to(state, t) : Outcome::reached_end;
    if (outcome == Outcome::reached_end) state.t = t;
    return outcome;
  };
  t_end_ = t_end;
  if (moves) {
    has_begun_ = true;
    set_out(state);
  }
  for (const double t : observer.times) {
    if (const Outcome outcome = go_to(t); outcome != Outcome::reached_end) return outcome;
    observer.see(state);
  }
  return go_to(t_end);
}

}  // namespace qddot
