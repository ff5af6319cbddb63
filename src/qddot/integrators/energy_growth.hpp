#pragma once

#include <cstdint>

#include "qddot/model/system.hpp"

namespace qddot {

// One plus the energy that a run gains, relative to the energy that its motion can turn into speed:
//   1 + (E_max - E(0)) / D,   D = the largest E(0) - V(q) seen.
// It is 1 for an exact motion, also for one that begins at rest and falls. It is 1 for a system
// without V. It is a lower bound, since not every E is computed:
//
//   - A look takes the kinetic energy and the distance from the start, some 0.2 of a step of the
//     cheapest method. The E of the states where they were largest are computed at the end. Looks
//     are after random steps, so that no oscillation is in step with them. The mean gap is half of
//     the steps so far and 256 at most. So a run of n > 512 steps has some 14 + n/256 of them.
//   - Methods of fixed steps know each step's speed. Looks are also where its square has doubled.
//   - E itself costs about a force. It is computed each time that the run has done the work of some
//     500, also at random: 0.2 % of the run.
class EnergyGrowth {
 public:
  // Borrows the system, which must outlive it.
  explicit EnergyGrowth(const System& system) : system_(system) {}

  // Begins a new run at `state`.
  void start(const State& state);
  // Call with |v|^2 of the next state.
  void see_speed(double squared) {
    if (squared > fast_) look_sooner(squared);
  }
  // Whether is_due() will be true at the next state.
  bool looks_next() const { return until_look_ == 1; }
  // Call after each accepted state, and look() at that state if it is true.
  bool is_due() { return --until_look_ == 0; }
  // `work`: of the run so far, in forces.
  void look(const State& state, double work);
  // The growth in the run so far, which is at `state`; at least 1, at most 1e300.
  double factor(const State& state);

 private:
  struct Candidate {  // a state whose E is not yet computed, and what is large there
    double size = 0;
    Vec q, v;
  };
  void look_sooner(double squared_speed);
  void propose(Candidate& candidate, double size, const State& state);
  void see(const Vec& q, const Vec& v);
  double rounding();
  double drawn();

  const System& system_;
  int until_look_ = 1;                 // steps
  double steps_ = 1;                   // up to that look
  double fast_ = 0, next_energy_ = 0;  // the speed, squared, and the work of the next look at all
  std::uint32_t random_ = 1;
  double start_ = 0;              // E(0)
  double most_ = 0, lowest_ = 0;  // E and V so far
  Candidate fastest_, farthest_;
  Vec q_;  // at the start
};

}  // namespace qddot
