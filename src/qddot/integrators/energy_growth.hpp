#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// One plus the energy that a run gains, relative to the energy that its motion can turn into speed:
//   1 + (E_max - E(0)) / D,   D = the largest E(0) - V(q) seen.
// It is 1 for an exact motion, also for one that begins at rest and falls. E is computed at the
// start, at the end and at every 1024th step. It is also computed where the kinetic energy was
// largest (to a factor of two, of every 32nd step). So the result is a lower bound, at a cost that
// a run does not notice. It is 1 for a system without V.
class EnergyGrowth {
 public:
  // Borrows the system, which must outlive it.
  explicit EnergyGrowth(const System& system) : system_(system) {}

  // Begins a new run at `state`.
  void start(const State& state);
  // Whether note() will look at the next state.
  bool looks_next() const { return until_look_ == 1; }
  // Call with each accepted state.
  void note(const State& state) {
    if (--until_look_ == 0) look(state);
  }
  // The growth in the run so far, which is at `state`; at least 1, at most 1e300.
  double factor(const State& state);

 private:
  void look(const State& state);
  void see(const Vec& q, const Vec& v);
  double rounding();

  const System& system_;
  int until_look_ = 1, looks_ = 0;
  double start_ = 0;                     // E(0)
  double most_ = 0, lowest_ = 0;         // E and V so far
  double kinetic_ = 0;                   // the largest, at a state whose E is not yet computed,
  Vec q_of_kinetic_, v_of_kinetic_, q_;  // that state; q at the start
};

}  // namespace qddot
