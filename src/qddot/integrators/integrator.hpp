#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "qddot/algebra/solver.hpp"
#include "qddot/integrators/energy_growth.hpp"
#include "qddot/integrators/options.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {

struct Method;
class MasslessBalance;

// How a run ended. Everything but reached_end is a failure, and a failure is data.
enum class Outcome {
  reached_end,
  diverged,              // speeds grew beyond any bound
  newton_failed,         // a nonlinear solve did not converge
  indefinite_matrix,     // M - h^2 K is singular or not positive definite where it must be
  step_too_small,        // t + h == t, or an adaptive method's step collapsed
  singular_mass,         // a massless node, and a method that divides by M
  not_finite,            // a force, energy or start value is no number
  solver_failed,         // a library gave up for another reason
  over_budget,           // stopped from outside
  stiffness_varies,      // a method for constant K, and a system whose K varies
  went_slack,            // compressed springs at a massless node (Validity, MasslessBalance)
  no_stiff_set,          // a method that takes stiff forces apart, and none are named (SplitForces)
  no_laplacian,          // a method that takes L in place of -K, and a system that has none
  no_stiffness,          // a method that needs K, and a system without K
  no_discrete_gradient,  // a method that needs one, and a system without one
};

std::string_view name(Outcome outcome);    // the enumerator's
std::string_view advice(Outcome outcome);  // one sentence: what it means and what to change

// The work of a run. `steps` counts accepted steps, `solves` counts right-hand sides.
struct Counts {
  std::int64_t steps = 0, rejected = 0, force_evaluations = 0, stiffness_evaluations = 0,
               factorizations = 0, solves = 0, newton_iterations = 0;
  std::int64_t indefinite_factorizations = 0;  // of indefinite matrices, in SUNDIALS' methods
  // The sum of the orders of all steps, and how often it was lowered; for methods of variable
  // order.
  std::int64_t order_sum = 0, order_reductions = 0;
  std::int64_t stability_limited_steps = 0;  // held to 1/w_max by adaptive explicit methods

  bool operator==(const Counts&) const = default;
  Counts& operator+=(const Counts& more);
};

// The time of a run by kinds of work [s]; zero unless Options::timed.
struct Seconds {
  double force = 0, stiffness = 0, factorization = 0, solve = 0;

  Seconds& operator+=(const Seconds& more);
};

// Adds the time [s] from its construction to its destruction to one member of Seconds.
class Stopwatch {
 public:
  Stopwatch(Seconds* seconds, double Seconds::*which) : seconds_(seconds), which_(which) {
    if (seconds_) start_ = std::chrono::steady_clock::now();
  }
  ~Stopwatch() {
    using seconds = std::chrono::duration<double>;
    if (seconds_) seconds_->*which_ += seconds(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Seconds* seconds_;  // may be nullptr
  double Seconds::*which_;
  std::chrono::steady_clock::time_point start_;
};

// The mean order of the steps; NaN for a method of fixed order.
inline double order_mean(const Counts& counts) {
  return counts.order_sum > 0
             ? static_cast<double>(counts.order_sum) / static_cast<double>(counts.steps)
             : std::numeric_limits<double>::quiet_NaN();
}

// A run's end, and the work that it took.
struct Summary {
  Outcome outcome = Outcome::solver_failed;
  double t_reached = 0;  // [s]
  Counts counts;
  Seconds seconds;
  std::string message = "advance was not called";  // one sentence; empty if the end was reached
  // The energy growth of the run (see EnergyChange); of several parts the largest.
  double energy_growth = 1;
  // The number of the failed step, 1, 2, ..., in the part that failed; 0 if the end was reached.
  std::int64_t failed_step = 0;
  // The energy [J] that was lost by the end of the run, and that part of the energy which its
  // motion can turn into speed (EnergyChange); zero if none was lost.
  double energy_lost = 0, energy_loss = 0;
};

// Observes a run: `see` is called at each of `times` [s] (ascending, after the start, at most
// t_end) and at no other time. Fixed-step methods, and methods with Trait::interpolates, take the
// same steps with and without an observer. A fixed-step method shows between its steps the end of a
// shorter step from the last one. Adaptive methods of SUNDIALS end steps on these times.
struct Observer {
  std::vector<double> times;
  std::function<void(const State&)> see;
  // If set, called with each accepted step of a system without blocks. It changes no step.
  std::function<void(const State&)> step{};
};

// Steps a System through time. Borrows the system, which must outlive it; owns its scratch space.
class Integrator {
 public:
  Integrator(const Method& method, const System& system, const Options& options);
  virtual ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  // Integrates from `state` to t_end >= state.t [s] and leaves the result in `state`; each call is
  // a fresh run. If the run fails, `state` is the last accepted one, or the last observed one if no
  // step followed. `stop` ends the run after the present step (over_budget). Throws
  // std::invalid_argument if sizes, times or the observer are not allowed. Exceptions of the
  // system's functions and of the observer pass through, except std::bad_alloc, which is an
  // outcome.
  Summary advance(State& state, double t_end, const Observer& observer = {},
                  std::stop_token stop = {});

  // The time [s] that the run has reached; may be called from another thread.
  virtual double reached() const { return reached_.load(std::memory_order_relaxed); }

 protected:
  // Called once a run, before start(): for base classes that step any formula.
  virtual void begin(const State&) {}
  // Called once a run, before the first step.
  virtual void start(const State&) {}
  // Brings `state` from its time to t_stop exactly; called for each of the observer's times and for
  // t_end. A method's own steps may be beyond t_stop (never beyond t_end) or short of it. It then
  // shows the state that it would have at t_stop.
  virtual Outcome run_to(State& state, double t_stop) = 0;

  const System& system() const { return system_; }
  const Method& method() const { return method_; }
  const Options& options() const { return options_; }
  Counts& counts() { return counts_; }
  // The record of times; nullptr unless the run is timed.
  Seconds* seconds() { return options_.timed ? &seconds_ : nullptr; }
  // The end of the run [s]; known from start() on.
  double t_end() const { return t_end_; }
  bool must_stop() const {
    return stop_.stop_requested() ||
           (options_.most_forces > 0 && counts_.force_evaluations >= options_.most_forces);
  }
  // Whether the step from `from` to `to` can be accepted: reached_end, or the reason why not
  // (not_finite, diverged, went_slack).
  Outcome check_step(const State& from, const State& to);
  // The same if |v|^2 of `to` is known.
  Outcome check_step(const State& from, const State& to, double squared_speed);
  // Whether check_step() looks at more than the size of the velocities.
  bool checks_velocities() const { return validity_; }
  // The outcome of a run that ends because its matrix at q (n) is not positive definite:
  // went_slack if springs do not hold a massless node there, else indefinite_matrix.
  Outcome indefinite_at(const Vec& q);
  // Call with |v|^2 of a state that will be accepted, if it is known; note() then looks closer.
  void see_speed(double squared) { growth_.see_speed(squared); }
  // Whether note() reads the velocities of the next state.
  bool looks_next() const { return growth_.looks_next() || shows_steps_; }
  // Call with each state that is accepted.
  void note(const State& state) {
    if (growth_.is_due()) growth_.look(state, work());
    if (shows_steps_) shown_steps_(state);
    reached_.store(state.t, std::memory_order_relaxed);
  }
  // Joins another's run: ends no later and is stopped with it.
  void join(const Integrator& run);
  // Takes over the counts, seconds and message of another since the last call.
  void take_over(Integrator& other);
  // Prepares everything before the first step of a run.
  void set_out(const State& state);
  // The reason for the outcome, in a sentence.
  std::string words_on(Outcome outcome) const;
  // The outcome of a solve as that of a run: reached_end, indefinite_matrix, or solver_failed with
  // a message.
  Outcome check_solve(SolveOutcome solution);
  // Sets a message that says more than the outcome's advice.
  void set_message(std::string message) { message_ = std::move(message); }

  // The force and stiffness of the system, or of a system with a part of its forces; counted.
  void force(const ConstVec& q, MutableVec f) { force(system_, q, f); }
  void force(const System& part, const ConstVec& q, MutableVec f) {
    ++counts_.force_evaluations;
    const Stopwatch watch(seconds(), &Seconds::force);
    part.force(q, f);
  }
  void stiffness(const ConstVec& q, SymmetricMatrix& k) { stiffness(system_, q, k); }
  void stiffness(const System& part, const ConstVec& q, SymmetricMatrix& k) {
    ++counts_.stiffness_evaluations;
    const Stopwatch watch(seconds(), &Seconds::stiffness);
    part.stiffness(q, k);
  }
  // Likewise the system's DiscreteGradient, counted as a force; for methods that need it.
  void discrete_gradient(const ConstVec& a, const ConstVec& b, MutableVec f) {
    ++counts_.force_evaluations;
    const Stopwatch watch(seconds(), &Seconds::force);
    discrete_gradient_->discrete_gradient(a, b, f);
  }
  // Likewise SplitStiffness::weighted_stiffness. If the system has none, this is the weight times
  // all of K. As the weight goes to 0, M - s K goes to M, which is positive definite.
  void weighted_stiffness(const ConstVec& q, double compression_weight, SymmetricMatrix& k) {
    ++counts_.stiffness_evaluations;
    const Stopwatch watch(seconds(), &Seconds::stiffness);
    if (split_stiffness_) {
      split_stiffness_->weighted_stiffness(q, compression_weight, k);
      return;
    }
    system_.stiffness(q, k);
    if (compression_weight != 1) k.coeffs() *= compression_weight;
  }

 private:
  friend class Parts;  // runs several integrators as one

  Outcome run(State& state, double t_end, const Observer& observer);
  // The work of the run so far, in forces.
  double work() const;
  // The change of the energy in the run up to `state`.
  virtual EnergyChange energy_change(const State& state) { return growth_.change(state); }

  const Method& method_;
  const System& system_;
  // The system's capabilities; nullptr for a missing one.
  const SplitStiffness* split_stiffness_;
  const DiscreteGradient* discrete_gradient_;
  const Validity* validity_;
  Options options_;
  Counts counts_;
  Seconds seconds_;
  double t_end_ = 0;
  std::stop_token stop_;
  std::function<void(const State&)> shown_steps_;  // Observer::step
  bool shows_steps_ = false;
  std::string message_;
  EnergyGrowth growth_;
  std::unique_ptr<MasslessBalance> balance_;  // only if there are massless nodes
  bool has_begun_ = false;
  std::atomic<double> reached_ = 0;  // [s]
  double slack_at_ = 0;              // [s], time of the outcome went_slack
  std::int64_t failed_step_ = 0;
};

// The outcome of that name (see name(Outcome)); nothing if there is none.
inline std::optional<Outcome> find_outcome(std::string_view word) {
  for (int i = 0; i <= static_cast<int>(Outcome::no_discrete_gradient); ++i) {
    if (name(static_cast<Outcome>(i)) == word) return static_cast<Outcome>(i);
  }
  return {};
}

}  // namespace qddot
