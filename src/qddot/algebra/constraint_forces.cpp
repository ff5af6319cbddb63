#include "qddot/algebra/constraint_forces.hpp"

#include <limits>

namespace qddot {

ConstraintForces::ConstraintForces(const System& system) {
  add(system, 0);
  Index count = 0;
  for (const Block& block : blocks_) count += block.multipliers->count();
  all_.setZero(count);
}

void ConstraintForces::add(const System& system, Index first) {
  if (system.constraints())
    blocks_.push_back({&system, first, std::make_unique<Multipliers>(system)});
  for (const auto& block : system.blocks()) {
    add(*block, first);
    first += block->size();
  }
}

const Vec& ConstraintForces::at(const State& state) {
  Index next = 0;
  for (Block& block : blocks_) {
    Multipliers& multipliers = *block.multipliers;
    const At at = At(state).segment(block.first, block.system->size());
    auto own = all_.segment(next, multipliers.count());
    next += multipliers.count();
    multipliers.take_gradients(at);
    if (multipliers.factorize()) {
      f_.resize(block.system->size());
      block.system->force(at, f_);
      own = multipliers.forces_at(at, f_);
    } else {
      own.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return all_;
}

}  // namespace qddot
