#pragma once

#include <span>
#include <utility>

#include "qddot/integrators/integrator.hpp"

namespace qddot::sundials {

// The reason why a library of SUNDIALS failed, whatever its own flag for it.
enum class Cause {
  error_test,        // the estimated error of a step stayed too large however short the step
  accuracy,          // the tolerances ask for more than rounding allows
  convergence,       // Newton's iteration did not converge however short the step
  setup,             // no factors could be made
  force,             // f or K is not finite within the next step, even a shorter one
  first_force,       // f is not finite at the start
  consistent_start,  // no positions of massless nodes were found that balance them
  loose_massless,    // springs no longer hold a massless node
  relaxation,        // no shorter or longer step keeps the energy
  fast_steps,        // the small steps inside a large one are below rounding
  end_too_close,     // the time to run is below rounding
  other,
};

Outcome outcome_of(Cause cause);
// The event as the beginning of a sentence, and the remedy as its end.
const char* what_happened(Cause cause);
const char* what_to_turn(Cause cause, bool has_fixed_step);

// The cause of a library's flag in the table of its flags; `other` if the flag is not in it.
Cause cause_in(std::span<const std::pair<int, Cause>> table, int flag);

}  // namespace qddot::sundials
