#include "src/algebra/effective_mass.hpp"

#include "src/algebra/cholmod_factors.hpp"
#include "src/algebra/multifrontal.hpp"

namespace qddot {

EffectiveMass::EffectiveMass(const System& system, Solver solver)
    : EffectiveMass(system, system.mass(), solver) {}

EffectiveMass::EffectiveMass(const System& system, Vec diagonal, Solver solver)
    : factors_(solver == Solver::cholmod
                   ? make_cholmod_factors(system.stiffness_pattern(), std::move(diagonal))
                   : make_multifrontal(system.stiffness_pattern(), std::move(diagonal))) {}

}  // namespace qddot
