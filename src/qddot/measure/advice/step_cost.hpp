#pragma once

#include "qddot/integrators/method.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::inline measure {

// The number of forces that a step of h [s] of an explicit method evaluates, from a few steps from
// the start of the model. It serves until the method was timed on the model. Start-up forces are
// not counted.
double forces_a_step(const Method& method, const ReducedScene& model, double h);

// The time [s] of one evaluation of f at the start: the least of three.
double seconds_of_force(const ReducedScene& model);

}  // namespace qddot::inline measure
