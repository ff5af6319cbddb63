#pragma once

#include "qddot/integrators/method.hpp"
#include "qddot/model/system.hpp"

namespace qddot::measure {

// What a step of the method takes on a system, in steps of Verlet's method: as measured on other
// scenes of as many unknowns (see step_cost.cpp), for what has not been timed on this one. Infinite
// where it was never measured. The linearly implicit methods solve for the unknowns alone that feel
// stiff forces, where these are told apart.
double usual_step_cost(const Method& method, const System& system);

// What an implicit method takes before its steps, in these: it analyses the pattern of K, and its
// first, long steps take the most iterations.
double steps_to_begin(const Method& method, const System& system);

// Forces that the method evaluates before its first step, beside those of its steps.
double forces_to_begin(const Method& method);

}  // namespace qddot::measure
