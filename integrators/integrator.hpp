#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
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
  stiffness_varies,      // a method for constant K, and a system whose K is not
  went_slack,            // compressed springs at a massless node (Validity, MasslessBalance)
  no_stiff_set,          // a method that takes stiff forces apart, and none are named (SplitForces)
  no_laplacian,          // a method that takes L in the place of -K, and a system that has none
  no_stiffness,          // a method that needs K, and a system that computes none
  no_discrete_gradient,  // a method that needs one of V, and a system that computes none
};

std::string_view name(Outcome outcome);    // as above
std::string_view advice(Outcome outcome);  // one sentence: what it means and what to turn

// The work done. Steps are accepted ones; solves are right-hand sides.
struct Counts {
  std::int64_t steps = 0, rejected = 0, force_evaluations = 0, stiffness_evaluations = 0,
               factorizations = 0, solves = 0, newton_iterations = 0;
  std::int64_t indefinite_factorizations = 0;  // of the factorisations, in SUNDIALS' methods
  // The orders of all steps added up, and how often it was lowered; of methods of variable order.
  std::int64_t order_sum = 0, order_reductions = 0;
  std::int64_t stability_limited_steps = 0;  // of adaptive explicit methods: held to 1/w_max

  bool operator==(const Counts&) const = default;
  Counts& operator+=(const Counts& more);
};

// Where the time of a run went [s]; zero unless Options::timed.
struct Seconds {
  double force = 0, stiffness = 0, factorization = 0, solve = 0;

  Seconds& operator+=(const Seconds& more);
};

// Adds the time from its construction to its end to one of them.
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
  Seconds* seconds_;  // may be none
  double Seconds::*which_;
  std::chrono::steady_clock::time_point start_;
};

// The mean order of the steps of a method of variable order; no number for the others.
inline double order_mean(const Counts& counts) {
  return counts.order_sum > 0
             ? static_cast<double>(counts.order_sum) / static_cast<double>(counts.steps)
             : std::numeric_limits<double>::quiet_NaN();
}

struct Summary {
  Outcome outcome = Outcome::solver_failed;
  double t_reached = 0;  // [s]
  Counts counts;
  Seconds seconds;
  std::string message = "advance was not called";  // one sentence; empty where the end was reached
  // The largest energy against that of the start (see EnergyGrowth); of several parts the largest.
  double energy_growth = 1;
  // Which step failed, 1, 2, ..., of the part that failed; 0 where the end was reached.
  std::int64_t failed_step = 0;
};

// Looks at a run from outside: `see` is called at each of `times` [s] (ascending, after the start,
// at most t_end) and at no other. Methods of fixed steps, and those that interpolate
// (Method::interpolates), take the same steps with and without an observer; what it sees between
// the steps of the former is where a shorter step from the last one would lead. Adaptive methods of
// SUNDIALS land on those times.
struct Observer {
  std::vector<double> times;
  std::function<void(const State&)> see;
};

// Steps a System through time. Borrows the system, which must outlive it; owns its scratch space.
class Integrator {
 public:
  Integrator(const Method& method, const System& system, const Options& options);
  virtual ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  // Runs from `state` to t_end >= state.t [s]; each call is a fresh run. On failure `state` is the
  // last accepted one, or the one last observed where no step was taken after it.
  // `stop` ends the run after the step at hand (over_budget). Throws std::invalid_argument where
  // sizes, times or the observer cannot be, and what the system's own functions or the observer
  // throw, memory that runs out excepted.
  Summary advance(State& state, double t_end, const Observer& observer = {},
                  std::stop_token stop = {});

  // The time [s] that the run has come to, for another thread to look at while it goes on.
  virtual double reached() const { return reached_.load(std::memory_order_relaxed); }

 protected:
  // Called once a run, before start(): for what steps a method, whatever its formula.
  virtual void begin(const State&) {}
  // Called once a run, before the first step.
  virtual void start(const State&) {}
  // Brings `state` from its time to t_stop exactly. Called for each of the observer's times and for
  // t_end. A method may have gone beyond t_stop, but never beyond t_end, or not as far, and show
  // where it would be.
  virtual Outcome run_to(State& state, double t_stop) = 0;

  const System& system() const { return system_; }
  const Method& method() const { return method_; }
  const Options& options() const { return options_; }
  Counts& counts() { return counts_; }
  // Where to add the time that something takes, if anywhere.
  Seconds* seconds() { return options_.timed ? &seconds_ : nullptr; }
  // Where the run is to end [s]; known from start() on.
  double t_end() const { return t_end_; }
  bool must_stop() const { return stop_.stop_requested(); }
  // Whether the state after a step from the one before can be accepted: reached_end, or else why
  // not (not_finite, diverged, went_slack).
  Outcome check_step(const State& from, const State& to);
  // The same where |v|^2 of `to` is known.
  Outcome check_step(const State& from, const State& to, double squared_speed);
  // Whether that looks at more than the size of the velocities.
  bool checks_velocities() const { return validity_; }
  // Whether note() will look at the velocities of the next state.
  bool looks_next() const { return growth_.looks_next(); }
  // To be called with each state that is accepted.
  void note(const State& state) {
    growth_.note(state);
    reached_.store(state.t, std::memory_order_relaxed);
  }
  // Becomes a part of another's run: ends no later and is stopped with it.
  void join(const Integrator& run);
  // Takes over what another has done since it was last asked, and what it has to say of it.
  void take_over(Integrator& other);
  // All that comes before the first step of a run.
  void set_out(const State& state);
  // Why it ended so, in a sentence.
  std::string words_on(Outcome outcome) const;
  // Whether a solve found what it was to find: reached_end, or else why not (indefinite_matrix, or
  // solver_failed, which is explained).
  Outcome check_solve(SolveOutcome solution);
  // Says more than the outcome's advice does.
  void set_message(std::string message) { message_ = std::move(message); }

  // The force and stiffness of the system, or of one that is a part of its forces; counted.
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
  // Likewise SplitStiffness::weighted_stiffness. Where a system does not offer it, this is the
  // weight times all of K: with the weight going to 0, M - s K goes to M, which is positive
  // definite.
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
  friend class Parts;  // which runs several as one

  Outcome run(State& state, double t_end, const Observer& observer);
  // The growth in the run up to `state`.
  virtual double energy_growth(const State& state) { return growth_.factor(state); }

  const Method& method_;
  const System& system_;
  // What the system offers; nullptr where it does not.
  const SplitStiffness* split_stiffness_;
  const DiscreteGradient* discrete_gradient_;
  const Validity* validity_;
  Options options_;
  Counts counts_;
  Seconds seconds_;
  double t_end_ = 0;
  std::stop_token stop_;
  std::string message_;
  EnergyGrowth growth_;
  std::unique_ptr<MasslessBalance> balance_;  // where there are massless nodes
  bool has_begun_ = false;
  std::atomic<double> reached_ = 0;  // [s]
  double slack_at_ = 0;              // [s], where went_slack
  std::int64_t failed_step_ = 0;
};

}  // namespace qddot
