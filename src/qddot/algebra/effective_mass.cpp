#include "qddot/algebra/effective_mass.hpp"

#include "qddot/algebra/automatic_factors.hpp"
#include "qddot/algebra/conjugate_gradients.hpp"

namespace qddot {
namespace {

std::unique_ptr<Factors> make_factors(Solver solver, const SymmetricMatrix& pattern, Vec diagonal) {
  switch (solver) {
    case Solver::cholmod:
      return make_cholmod_factors(pattern, std::move(diagonal));
    case Solver::conjugate_gradients:
      return make_conjugate_gradients(pattern, std::move(diagonal));
    case Solver::automatic:
      return make_automatic_factors(pattern, std::move(diagonal));
    case Solver::multifrontal:
      break;
  }
  return make_multifrontal(pattern, std::move(diagonal));
}

}  // namespace

EffectiveMass::EffectiveMass(const System& system, Solver solver)
    : EffectiveMass(system, system.mass(), solver) {}

EffectiveMass::EffectiveMass(const System& system, Vec diagonal, Solver solver)
    : factors_(make_factors(solver, system.stiffness_pattern(), std::move(diagonal))) {}

}  // namespace qddot
