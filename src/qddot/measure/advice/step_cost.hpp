#pragma once

#include "qddot/integrators/method.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// The number of forces that a step of an explicit method of fixed steps evaluates, counted on an
// oscillator. Start-up forces are left out. Thread-safe.
double forces_a_step(const Method& method);

// The time [s] of one evaluation of f at the start: the least of three.
double seconds_of_force(const Model& model);

}  // namespace qddot::inline measure
