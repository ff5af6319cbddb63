#pragma once

#include "qddot/integrators/method.hpp"
#include "qddot/model/system.hpp"

namespace qddot::inline measure {

// The time of a step of the method on the system, in steps of Verlet's method. It was measured on
// other scenes of that size (see step_cost.cpp) and serves until the method was timed on this
// scene. Infinite if it was never measured. It allows for methods that solve for the stiff
// unknowns only (Method::solves_stiff_part).
double usual_step_cost(const Method& method, const System& system);

// The time that an implicit method takes before its steps, in its steps. It analyses the pattern of
// K, and its first, long steps take the most iterations.
double steps_to_begin(const Method& method, const System& system);

// The number of forces that the method evaluates before its first step.
double forces_to_begin(const Method& method);

}  // namespace qddot::inline measure
