#pragma once

#include <vector>

#include <Eigen/SparseCholesky>

#include "qddot/model/system.hpp"

namespace qddot {

// Whether massless nodes stay where their forces balance. They do in a minimum of V over their
// positions: -K among their unknowns is positive semidefinite there. Where it is not, as between
// compressed springs, the balance is one that a node without mass leaves in no time, and no
// equation of motion says where to.
class MasslessBalance {
 public:
  // The system must have massless nodes and a K. An eigenvalue is negative where it is below
  // -tolerance times the stiffness of the nodes around.
  MasslessBalance(const System& system, double tolerance);

  // With stiffness(k), which brings the K of the place.
  template <class Stiffness>
  bool is_stable(const Stiffness& stiffness) {
    stiffness(k_);
    return is_stable();
  }

 private:
  bool is_stable();

  double tolerance_;
  SymmetricMatrix k_, own_;       // K; and -K among the massless unknowns, shifted
  std::vector<Index> source_;     // of each entry of the latter, its place in K
  std::vector<Index> diagonals_;  // places of its diagonal
  Vec scale_;
  Eigen::SimplicialLDLT<SymmetricMatrix, Eigen::Lower> factors_;
};

}  // namespace qddot
