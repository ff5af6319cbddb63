#pragma once

#include <string>
#include <utility>

#include "qddot/integrators/system_run.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {

// A formula of steps of a given length: step(x, h) gives x' and an outcome. A derived class has
//   Outcome step(const X& x, double h, X& next)
// which computes `next`, h [s] after x; next.t is set before. Any outcome but reached_end ends the
// run at x. FixedSteps runs it.
//
// x is a State for most formulas. One that advances other numbers has a struct X of its own,
// derived from State, with q always right, and in addition:
//   void begin(const State& state, X& x)                       the x of a state
//   void show(X& x, bool may_evaluate, State& state)           the state of an x
//   double squared_speed(const X& next)                        |v|^2 of that state, or nearly
// If not `may_evaluate`, forces or the motion have failed and must not be evaluated; then show()
// comes as near as that allows.
//
// A state between two steps is the end of a shorter step from the first of them, by another object
// of the formula, so that the memory of this one does not change. That object begins from the state
// of x, unless the formula has
//   void resume(const Formula& run, const X& x, X& own)        continues from the x of `run`
// A formula of a library that counts by itself has collect_counts(), as Stepper has.
//
// If the system has Damping or Driving, a step sets next.work: x.work and what friction takes and
// driving gives in the step, by the formula's own quadrature of both powers.
class Formula {
 public:
  using X = State;

  explicit Formula(SystemRun& run) : run_(run) {}

  // Prepares for steps from a state; called once a run. A formula that begins with something hides
  // this.
  void begin(const State& state, State& x) { x = state; }
  double squared_speed(const State& next) { return squared_norm(next.v); }

 protected:
  const Method& method() const { return run_.method(); }
  const Options& options() const { return run_.options(); }
  const System& system() const { return run_.system(); }
  Counts& counts() { return run_.counts(); }
  Seconds* clock() { return run_.counted().clock(); }
  double t_end() const { return run_.t_end(); }

  bool is_damped() const { return system().damping() != nullptr; }
  bool is_driven() const { return run_.counted().driving() != nullptr; }
  // Whether it has either, so that a step sets next.work.
  bool does_work() const { return is_damped() || is_driven(); }

  // The functions of CountedSystem.
  void force(const At& at, MutableVec f) { run_.counted().force(at, f); }
  double force_beside(const At& at, MutableVec f, BesideForce& beside) {
    return run_.counted().force_beside(at, f, beside);
  }
  double potential(const At& at) const { return run_.counted().potential(at); }
  void force(const System& part, const At& at, MutableVec f) { run_.counted().force(part, at, f); }
  const Vec& friction() const { return run_.counted().friction(); }
  // Moves that friction into a vector, in place of a copy.
  void take_friction(Vec& to) { to.swap(run_.counted().friction()); }
  Work power() const { return run_.counted().power(); }
  Work power(const At& at) { return run_.counted().power(at); }
  const Work& driving_power() const { return run_.counted().driving_power(); }
  // The work of a kick of h by the last force, which led from one velocity to another: that of
  // driving, and that of friction along their mean.
  Work work_of_kick(double h, const Vec& before, const Vec& after) const {
    Work work = h * driving_power();
    if (is_damped()) work.dissipated -= h / 2 * (before + after).dot(friction());
    return work;
  }
  void subtract_damping(const System& part, const At& at, double rate, SymmetricMatrix& k) {
    run_.counted().subtract_damping(part, at, rate, k);
  }
  void mean_force(const At& a, const At& b, MutableVec f) { run_.counted().mean_force(a, b, f); }
  void stiffness(const At& at, SymmetricMatrix& k) { run_.counted().stiffness(at, k); }
  void stiffness(const System& part, const At& at, SymmetricMatrix& k) {
    run_.counted().stiffness(part, at, k);
  }

  // The functions of SystemRun.
  bool must_stop() const { return run_.must_stop(); }
  void set_message(std::string message) { run_.set_message(std::move(message)); }
  Outcome check_solve(SolveOutcome solution) { return run_.check_solve(solution); }
  Outcome indefinite_at(const At& at) { return run_.indefinite_at(at); }

  SystemRun& run_;
};

}  // namespace qddot
