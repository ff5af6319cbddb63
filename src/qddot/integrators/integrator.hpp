#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "qddot/integrators/system_run.hpp"

namespace qddot {

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
  // The work of damping, driving and breaking in the run [J]; no loss or gain of the method.
  Work work{};
  // The springs that broke, ascending in time, by the numbers of the whole system; and the number
  // of all moments at which springs went slack, taut, or broke and steps ended.
  std::vector<Break> breaks{};
  std::int64_t phase_changes = 0;
};

// Observes a run: `see` is called at each of `times` [s] (ascending, after the start, at most
// t_end) and at no other time. Fixed-step methods, and methods with Trait::interpolates, take the
// same steps with and without an observer. A fixed-step method shows between its steps the end of a
// shorter step from the last one. Other adaptive methods, those of SUNDIALS, end steps on these
// times.
struct Observer {
  std::vector<double> times;
  std::function<void(const State&)> see;
  // If set, called with each accepted step of a system without blocks. It changes no step.
  std::function<void(const State&)> step{};
};

// Steps a System through time by a method. Borrows both, which must outlive it; owns its scratch
// space.
//
// A system of blocks runs as one run with one outcome. Each block is a SystemRun of its own and, if
// the method is adaptive, has its own steps. Counts and seconds are sums over the blocks. If a
// block fails, the others are brought to the time that it reached; the earliest of several failures
// decides. A run stopped from outside ends at the last time that all blocks share: its start or an
// observer's time. No time is left to bring them farther.
class Integrator {
 public:
  // Allocates and analyses all it needs. If the method does not fit the system (see misfit),
  // advance() says why and does nothing.
  Integrator(const Method& method, const System& system, const Options& options);

  // Integrates from `state` to t_end >= state.t [s] and leaves the result in `state`; each call is
  // a fresh run. If the run fails, `state` is the last accepted one, or the last observed one if no
  // step followed. `stop` ends the run after the present step (over_budget). Throws
  // std::invalid_argument if sizes, times or the observer are not allowed. Exceptions of the
  // system's functions and of the observer pass through, except std::bad_alloc, which is an
  // outcome.
  Summary advance(State& state, double t_end, const Observer& observer = {},
                  std::stop_token stop = {});

  // The time [s] that the run has reached; may be called from another thread. It is the mean time
  // of several blocks, which run one after another.
  double reached() const;

 private:
  // A block, or the whole of a system without blocks.
  struct Part {
    Index first;        // of its unknowns,
    Index first_phase;  // and of its phases (Switching)
    std::unique_ptr<SystemRun> run;
    State state{}, begin{};       // now, and where the present run_to began
    double growth = 1;            // of the energy, in runs that were undone
    std::exception_ptr thrown{};  // by its system or by the observer, in the present run_to
  };

  // Adds the blocks of the system, and those within them; unknowns and phases are from the first
  // ones on.
  void add_parts(const System& system, Index first, Index first_phase, const Options& options);
  // The part's own state.
  State state_of(const Part& part, const State& whole) const;
  bool is_whole() const { return parts_.size() == 1; }
  Outcome run(State& state, double t_end, const Observer& observer, std::stop_token stop);
  // The corners of forces in time, between these, that the method's order sees.
  std::vector<double> corners_between(double t, double t_end) const;
  Outcome run_to(State& state, double t_stop);
  // Brings several parts to one time: t_stop, or that of the first failure.
  Outcome run_parts_to(State& state, double t_stop);
  // Brings the part to t_end from its start, even if it has run from there before.
  Outcome run_part(Part& part, double t_end);
  // Collects the states of all parts.
  void gather(State& state) const;
  void gather_phases(State& state) const;
  EnergyChange energy_change(const State& state);

  const Method& method_;
  const System& system_;
  std::vector<Part> parts_;  // none if nothing can be run
  bool has_begun_ = false;
  Work work_{};  // by the start of the run [J]
  std::string message_;
  std::int64_t failed_step_ = 0;
};

}  // namespace qddot
