#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "src/model/system.hpp"

namespace qddot {

struct Method;

// How a run ended. Everything but reached_end is a failure, and a failure is data.
enum class Outcome {
  reached_end,
  diverged,           // speeds grew beyond any bound
  newton_failed,      // a nonlinear solve did not converge
  indefinite_matrix,  // M - h^2 K is singular or not positive definite where it must be
  step_too_small,     // t + h == t, or an adaptive method's step collapsed
  singular_mass,      // a massless node, and a method that divides by M
  not_finite,         // a force, energy or start value is no number
  solver_failed,      // a library gave up for another reason
  over_budget,        // stopped from outside
  stiffness_varies,   // a method for constant K, and a system whose K is not
  went_slack,         // the system no longer is what it stands for (System::holds_at)
  no_stiff_set,       // a method that takes stiff forces apart, and none are named (System::split)
};

std::string_view name(Outcome outcome);    // as above
std::string_view advice(Outcome outcome);  // one sentence: what it means and what to turn

// The work done. Steps are accepted ones; solves are right-hand sides.
struct Counts {
  std::int64_t steps = 0, rejected = 0, force_evaluations = 0, stiffness_evaluations = 0,
               factorizations = 0, solves = 0, newton_iterations = 0;
};

struct Summary {
  Outcome outcome = Outcome::solver_failed;
  double t_reached = 0;  // [s]
  Counts counts;
  std::string message = "advance was not called";  // one sentence; empty where the end was reached
};

// What a method is told before it runs: the one that belongs to its kind.
struct Knobs {
  double step_size = 0;  // h [s], of fixed-step methods
  double rtol = 0;       // relative tolerance of adaptive ones,
  double atol = 0;       // and the absolute one, in m for q and m/s for v; 0 = the same number
};

// Looks at a run from outside: `see` is called at each of `times` [s] (ascending, after the start,
// at most t_end) and at no other. Steps land on those times exactly; the last one before each is
// shortened where it must be.
struct Observer {
  std::vector<double> times;
  std::function<void(const State&)> see;
};

// Steps a System through time. Borrows the system, which must outlive it; owns its scratch space.
class Integrator {
 public:
  Integrator(const Method& method, const System& system, const Knobs& knobs)
      : method_(method), system_(system), knobs_(knobs) {}
  virtual ~Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  // Runs from `state` to t_end >= state.t [s]; each call is a fresh run. On failure `state` is the
  // last accepted one. Never throws; `stop` ends the run after the step at hand (over_budget).
  Summary advance(State& state, double t_end, const Observer& observer = {},
                  std::stop_token stop = {});

 protected:
  // Called once a run, before the first step.
  virtual void start(const State&) {}
  // Brings `state` from its time to t_stop exactly.
  virtual Outcome run_to(State& state, double t_stop) = 0;

  const System& system() const { return system_; }
  const Knobs& knobs() const { return knobs_; }
  Counts& counts() { return counts_; }
  bool must_stop() const { return stop_.stop_requested(); }
  // Says more than the outcome's advice does.
  void explain(std::string message) { message_ = std::move(message); }

  // The system's force and stiffness, counted.
  void force(const Vec& q, Vec& f) {
    ++counts_.force_evaluations;
    system_.force(q, f);
  }
  void stiffness(const Vec& q, SymmetricMatrix& k) {
    ++counts_.stiffness_evaluations;
    system_.stiffness(q, k);
  }

 private:
  friend class Parts;  // which runs several as one

  Outcome run(State& state, double t_end, const Observer& observer);

  const Method& method_;
  const System& system_;
  Knobs knobs_;
  Counts counts_;
  std::stop_token stop_;
  std::string message_;
};

}  // namespace qddot
