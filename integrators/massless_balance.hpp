#pragma once

#include <memory>
#include <vector>

#include <Eigen/SparseCholesky>

#include "qddot/model/system.hpp"

namespace qddot {

// Whether massless nodes stay where their forces balance. They do in a minimum of V over their
// positions: -K among their unknowns is positive semidefinite there. Where it is not, as between
// compressed springs, the balance is one that a node without mass leaves in no time, and no
// equation of motion says where to. A step beyond such a place may find another balance and never
// meet the unstable one: then nodes have jumped, which the balances at both its ends tell.
class MasslessBalance {
 public:
  // The system must have massless nodes and a K. At `start` they may be out of balance. An
  // eigenvalue is negative where it is below -tolerance times the stiffness of the nodes around.
  // `solve_tolerance`: the part of what was predicted wrongly that a solve of a step leaves.
  MasslessBalance(const System& system, Vec start, double tolerance, double solve_tolerance);

  // Whether they do after a step from state `from` to state `to`, and went there with the other
  // nodes. `force(q, f)` and `stiffness(q, k)` are the system's.
  template <class Force, class Stiffness>
  bool holds(const State& from, const State& to, const Force& force, const Stiffness& stiffness) {
    const auto look = [&](Place& place, const Vec& q) {
      place.q = q;
      force(q, place.f);
      stiffness(q, place.k);
      place.is_stable = factorize(place);
    };
    if (to_->q == from.q) {
      std::swap(from_, to_);
    } else {
      look(*from_, from.q);
    }
    look(*to_, to.q);
    return to_->is_stable && have_followed(to.t - from.t);
  }

 private:
  struct Place {
    Vec q, f;
    SymmetricMatrix k, own;  // K; and -K among the massless unknowns, shifted
    Eigen::SimplicialLDLT<SymmetricMatrix, Eigen::Lower> factors;  // of the latter
    bool is_stable = false;  // positive semidefinite, and factorised
  };

  bool factorize(Place& place);
  bool have_followed(double h);
  double led(const Place& place);

  double tolerance_, solve_tolerance_;
  Vec start_;
  std::unique_ptr<Place> from_ = std::make_unique<Place>(), to_ = std::make_unique<Place>();
  std::vector<Index> massless_;   // of each unknown its place among the massless ones, or -1
  std::vector<Index> source_;     // of each entry of `own`, its place in K
  std::vector<Index> diagonals_;  // places of its diagonal
  double speed_before_ = 0;       // to which the first balance of the step before led [m/s]
  double moved_before_ = 0;       // how far massless nodes went in it [m]
  Vec scale_, pull_;
};

}  // namespace qddot
