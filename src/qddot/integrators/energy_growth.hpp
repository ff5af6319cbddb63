#pragma once

#include <cstdint>

#include "qddot/model/system.hpp"

namespace qddot {

// The energy that a run gained on its way and lost by its end, beside the energy that its motion
// can turn into speed, D = the largest E(0) - V(q) seen. An exact motion has the first values of
// all, also if it begins at rest and falls. So has a system without V, or one that changes its
// energy. What damping has taken and driving has given (State::work) counts: only the method's own
// gain or loss is left, and D has all that driving has given or taken.
struct EnergyChange {
  double growth = 1;  // 1 + (E_max - E(0)) / D, a lower bound
  double lost = 0;    // E(0) - E at the end [J], unless rounding may have made it
  double own = 0;     // D [J]

  // The lost part of D.
  double loss() const { return lost > 0 && own > 0 ? lost / own : 0; }
};

// Watches a run for its EnergyChange. Not every E is computed:
//
//   - A look takes the kinetic energy and the distance from the start, some 0.2 of a step of the
//     cheapest method. The E of the states where they were largest are computed at the end. Looks
//     are after random steps, so that no oscillation is in step with them. The mean gap is half of
//     the steps so far and 256 at most. So a run of n > 512 steps has some 14 + n/256 of them.
//   - Methods of fixed steps know each step's speed. Looks are also where its square has doubled.
//   - E itself costs about a force. It is computed each time that the run has done the work of some
//     500, also at random: 0.2 % of the run.
//   - A step with the work of 20 forces and more has factorised K. A linearly implicit one can then
//     go anywhere and come back in a few steps, so the E of each is computed: 5 % of the run's work
//     at most.
class EnergyGrowth {
 public:
  // Borrows the system, which must outlive it.
  explicit EnergyGrowth(const System& system)
      : system_(system), is_conserved_(system.has_potential() && keeps_balance(system)) {}

  // Has the energies of the states from now on be those in these phases (see State).
  void stay_in(std::shared_ptr<const std::vector<Phase>> phases) { phases_ = std::move(phases); }
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
  // The change in the run so far, which is at `state`. Its growth is at least 1, at most 1e300.
  EnergyChange change(const State& state);

 private:
  struct Candidate {  // a state whose E is not yet computed, and what is large there
    double size = 0;
    State state;
  };
  double potential(const State& state) const {
    At at(state.t, state.q);
    if (state.phases) at.phases = state.phases->data();
    return system_.potential(at);
  }
  void look_sooner(double squared_speed);
  void propose(Candidate& candidate, double size, const State& state);
  double see(const State& state);          // returns E
  double see_present(const State& state);  // whose phases are the present ones
  double rounding();
  double drawn();

  const System& system_;
  std::shared_ptr<const std::vector<Phase>> phases_;
  const bool is_conserved_;            // whether the system computes its energy and keeps it
  int until_look_ = 1;                 // steps
  double steps_ = 1;                   // up to that look
  double fast_ = 0, next_energy_ = 0;  // the speed, squared, and the work of the next look at all
  std::uint32_t random_ = 1;
  double start_ = 0;              // E(0)
  double most_ = 0, lowest_ = 0;  // E and V so far
  double driven_ = 0;             // the most that driving gave or took [J]
  Candidate fastest_, farthest_;
  double t_ = 0;  // at the start
  Vec q_;
};

}  // namespace qddot
