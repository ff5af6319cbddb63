#pragma once

#include <optional>
#include <string_view>

namespace qddot {

// How a run ended. Everything but reached_end is a failure, and a failure is data.
enum class Outcome {
  reached_end,
  diverged,              // speeds grew beyond any bound
  newton_failed,         // a nonlinear solve did not converge
  indefinite_matrix,     // M - h^2 K is singular or not positive definite where it must be
  step_too_small,        // t + h == t, or an adaptive method's step collapsed
  singular_mass,         // a massless node, and a method that divides by M
  not_finite,            // a force, energy or start value is no number
  solver_failed,         // a library gave up for another reason
  over_budget,           // stopped from outside
  stiffness_varies,      // a method for constant K, and a system whose K varies
  went_slack,            // compressed springs at a massless node (Validity, MasslessBalance)
  no_stiff_set,          // a method that takes stiff forces apart, and none are named (Split)
  no_laplacian,          // a method that takes L in place of -K, and a system that has none
  no_stiffness,          // a method that needs K, and a system without K
  no_discrete_gradient,  // a method that needs one, and a system without one
  no_potential,          // a method that keeps the energy, and a system without V
  not_conservative,      // a method for forces of positions alone, and a system whose f sees v
  refuses_damping,       // a method that would lose its order with the system's Damping
  not_autonomous,        // a method for forces that stay the same, and a system whose f sees t
  no_constraints,        // a method that keeps Constraints, and a system without them
  refuses_constraints,   // a method that keeps none, and a system that has some
  chatters,              // springs change their phases without end (Switching)
};

std::string_view name(Outcome outcome);    // the enumerator's
std::string_view advice(Outcome outcome);  // one sentence: what it means and what to change

// The outcome of that name (see name(Outcome)); nothing if there is none.
std::optional<Outcome> find_outcome(std::string_view word);

}  // namespace qddot
