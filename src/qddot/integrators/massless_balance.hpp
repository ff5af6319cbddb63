#pragma once

#include <memory>
#include <vector>

#include <Eigen/SparseCholesky>

#include "qddot/model/capabilities.hpp"

namespace qddot {

// Whether an unknown without mass is beside a dashpot at q (n). It then moves at a finite speed, by
// an equation of first order, whatever its springs do.
bool has_massless_dashpots(const System& system, const Vec& q);

// Checks whether massless nodes stay where their forces balance. They do at a minimum of V over
// their positions: -K among their unknowns is positive semidefinite there. Otherwise, as between
// compressed springs, the balance is unstable: a node without mass leaves it at once, and no
// equation of motion determines its new place. A step may pass such a place and end in another
// balance. Then nodes have jumped, which the balances at both ends show.
class MasslessBalance {
 public:
  // The system must have massless nodes and a K; the nodes may be out of balance at `start` (n). An
  // eigenvalue is negative if it is below -tolerance times the stiffness of the nodes around it.
  // `solve_tolerance`: the part of a prediction's error that the solve of a step leaves.
  MasslessBalance(const System& system, Vec start, double tolerance, double solve_tolerance);

  // Whether massless nodes are in a stable balance after the step from `from` to `to`, and followed
  // the other nodes there. `force(at, f)` and `stiffness(at, k)` are the system's.
  template <class Force, class Stiffness>
  bool holds(const State& from, const State& to, const Force& force, const Stiffness& stiffness) {
    const auto look = [&](Place& place, const State& state) {
      const At at(state.t, state.q);
      place.q = state.q;
      force(at, place.f);
      if (driving_) driving_->force_rate(at, place.f_rate);
      stiffness(at, place.k);
      place.is_stable = factorize(place);
    };
    if (to_->q == from.q) {
      std::swap(from_, to_);
    } else {
      look(*from_, from);
    }
    look(*to_, to);
    return to_->is_stable && have_followed(to.t - from.t);
  }

  // Whether massless nodes there, balanced or not, are held in every direction. For the end of a
  // run: forgets the last step.
  template <class Stiffness>
  bool are_held_at(const At& at, const Stiffness& stiffness) {
    stiffness(at, to_->k);
    return factorize(*to_);
  }

 private:
  struct Place {
    Vec q, f, f_rate;        // the last if forces depend on time: df/dt
    SymmetricMatrix k, own;  // K; and -K among the massless unknowns, shifted
    Eigen::SimplicialLDLT<SymmetricMatrix, Eigen::Lower> factors;  // of the latter
    bool is_stable = false;  // positive semidefinite, and factorised
  };

  bool factorize(Place& place);
  bool have_followed(double h);
  double led(const Place& place, double h);

  const Driving* driving_;  // nullptr if nothing is driven
  double tolerance_, solve_tolerance_;
  Vec start_;
  std::unique_ptr<Place> from_ = std::make_unique<Place>(), to_ = std::make_unique<Place>();
  std::vector<Index> massless_;   // each unknown's place among the massless ones, or -1
  std::vector<Index> source_;     // the place in K of each entry of `own`
  std::vector<Index> diagonals_;  // places of its diagonal
  double speed_before_ = 0;       // [m/s], of the last step's first balance
  double moved_before_ = 0;       // [m], of massless nodes in that step
  Vec scale_, pull_;
};

}  // namespace qddot
