#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// How much more energy a run comes to than a motion that keeps its energy can have: with D the
// largest E(0) - V(q) seen, which is what the motion has to turn into speed,
//   1 + (E_max - E(0)) / D,
// 1 for an exact motion, also for one that begins at rest and falls. E is computed at the start, at
// the end, at every 1024th step and where the kinetic energy was largest (to a factor of two, of
// every 32nd step); so this is a lower bound, at a cost that a run does not notice. Of a system
// without V nothing is known, and the growth is 1.
class EnergyGrowth {
 public:
  // Borrows the system.
  explicit EnergyGrowth(const System& system) : system_(system) {}

  void start(const State& state);
  // Whether note() will look at the next state.
  bool looks_next() const { return until_look_ == 1; }
  // To be called with each accepted state.
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
  double kinetic_ = 0;                   // of where that was largest,
  Vec q_of_kinetic_, v_of_kinetic_, q_;  // which is not seen yet; and the start
};

}  // namespace qddot
