#pragma once

#include <memory>
#include <vector>

#include "qddot/algebra/multipliers.hpp"

namespace qddot {

// The multipliers of all constraints of a system at a state: for rods, their tensions.
class ConstraintForces {
 public:
  // Borrows the system, of which each block may have constraints.
  explicit ConstraintForces(const System& system);

  // The multipliers [N] in the order of the blocks and of their constraints; NaN for those of a
  // block whose constraints are singular there. They are what keeps the constraints with the forces
  // and velocities of the state.
  const Vec& at(const State& state);

 private:
  struct Block {
    const System* system;
    Index first;  // unknown
    std::unique_ptr<Multipliers> multipliers;
  };
  void add(const System& system, Index first);

  std::vector<Block> blocks_;  // those with constraints
  Vec all_, f_;
};

}  // namespace qddot
