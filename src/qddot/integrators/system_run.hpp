#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "qddot/algebra/solver.hpp"
#include "qddot/integrators/counted_system.hpp"
#include "qddot/integrators/energy_growth.hpp"
#include "qddot/integrators/options.hpp"
#include "qddot/integrators/outcome.hpp"
#include "qddot/integrators/spring_changes.hpp"
#include "qddot/integrators/stepper.hpp"

namespace qddot {

struct Method;
class MasslessBalance;

// A run of a method on one system without blocks. It drives the method's Stepper, watches the
// budget, the energy and what makes a step invalid, and counts. Formulas and steppers see it as the
// place of all that is not their own.
class SystemRun {
 public:
  // Allocates and analyses all that the method needs. Borrows the method and the system.
  SystemRun(const Method& method, const System& system, const Options& options);
  ~SystemRun();
  SystemRun(const SystemRun&) = delete;
  SystemRun& operator=(const SystemRun&) = delete;

  // For the driver, in this order.
  //
  // Forgets counts and times. `shown_steps` is called with each accepted step, if it is set.
  void clear(double t_end, std::stop_token stop, std::function<void(const State&)> shown_steps);
  // Prepares everything before the first step from `state`.
  void begin(const State& state);
  // Prepares steps from `state` up to t_end, which continue the run and know no earlier steps. They
  // stay in the piece of time between (see At).
  void begin_anew(const State& state, double t_end);
  // Has the steps from t stay in the piece of time up to t_end, their last end.
  void stay_before(double t, double t_end);
  // Brings `state` from its time to t_stop exactly. If it fails, `state` is the last accepted one,
  // or stays if no step followed it. Exceptions pass through, after the same.
  Outcome run_to(State& state, double t_stop);
  // The change of the energy in the run up to `state`.
  EnergyChange energy_change(const State& state) { return growth_.change(state); }
  // The reason for the outcome, in a sentence.
  std::string words_on(Outcome outcome) const;
  // The time [s] that the run has reached; may be called from another thread.
  double reached() const { return reached_.load(std::memory_order_relaxed); }

  // For formulas and steppers.
  const Method& method() const { return method_; }
  const Options& options() const { return options_; }
  CountedSystem& counted() { return system_; }
  const System& system() const { return system_.system(); }
  Counts& counts() { return system_.counts; }
  const Seconds& seconds() const { return system_.seconds; }
  // The end of the run [s].
  double t_end() const { return t_end_; }
  // Whether the budget is spent, or the run is stopped from outside.
  bool must_stop() const {
    return stop_.stop_requested() ||
           (options_.most_forces > 0 && system_.counts.force_evaluations >= options_.most_forces);
  }
  // The breakings of the run so far, and the number of all changes of springs' phases that steps
  // ended on.
  const std::vector<Break>& breaks() const { return changes_.breaks(); }
  std::int64_t phase_changes() const { return changes_.count(); }

  // Whether the step from `from` to `to` can be accepted: reached_end, or the reason why not
  // (not_finite, diverged, went_slack; or chatters, where a spring's phase ends in the step and
  // this run has still to find the moment). The second form is for a known |v|^2 of `to`, and reads
  // no velocities unless checks_velocities().
  Outcome check_step(const State& from, const State& to);
  Outcome check_step(const State& from, const State& to, double squared_speed);
  bool checks_velocities() const { return validity_ || changes_.are_possible(); }
  // The outcome of a run that ends because its matrix there is not positive definite: went_slack if
  // springs do not hold a massless node there, else indefinite_matrix.
  Outcome indefinite_at(const At& at);
  // The outcome of a solve as that of a run: reached_end, indefinite_matrix, or solver_failed with
  // a message.
  Outcome check_solve(SolveOutcome solution);
  // Sets a message that says more than the outcome's advice.
  void set_message(std::string message) { message_ = std::move(message); }
  // Call with |v|^2 of a state that will be accepted, if it is known; note() then looks closer.
  void see_speed(double squared) { growth_.see_speed(squared); }
  // Whether note() reads the velocities of the next state.
  bool looks_next() const { return growth_.looks_next() || shows_steps_; }
  // Call with each state that is accepted.
  void note(const State& state) {
    if (growth_.is_due()) growth_.look(state, work());
    // A try that looks for the end of a phase may be undone.
    if (shows_steps_ && !changes_.is_looking()) show_step(state);
    reached_.store(state.t, std::memory_order_relaxed);
  }

 private:
  // Calls shown_steps_ with the state and the phases that it has.
  void show_step(const State& state);
  // Takes all steps until t_stop is passed. They end on changes of springs' phases, where the
  // method begins anew. `state`: scratch, of the system's size.
  Outcome take_steps(double t_stop, State& state);
  // Takes steps in the present phases.
  Outcome take_smooth_steps(double t_stop);
  // Changes phases at `state` if they end there, and continues from there; else comes closer.
  Outcome land(State& state);
  // Begins anew at `state`, up to the next change that is known.
  void go_on(const State& state);
  // The work of the run so far, in forces.
  double work() const;

  const Method& method_;
  const Options options_;
  CountedSystem system_;
  const Validity* validity_;  // nullptr if the system is valid everywhere
  double t_end_ = 0;
  std::stop_token stop_;
  std::function<void(const State&)> shown_steps_;
  bool shows_steps_ = false;
  std::string message_;
  EnergyGrowth growth_;
  std::unique_ptr<MasslessBalance> balance_;  // only if there are massless nodes
  std::atomic<double> reached_ = 0;           // [s]
  double slack_at_ = 0;                       // [s], time of the outcome went_slack
  SpringChanges changes_;
  double piece_end_ = 0;  // [s], the last end of steps but for changes
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace qddot
