#pragma once

#include <string>

#include "qddot/integrators/integrator.hpp"

namespace qddot::command {

// Throws InvalidInput unless the relative tolerance is from 1e-15 to below 1. A step's error adds
// up several roundings of 2.2e-16, from which no smaller one can be told; at 1 an error of all that
// moves passes.
void require_rtol(double rtol, const std::string& option);

// Throws InvalidInput unless h [s] is finite, greater than 0, its square a number of full precision
// and, where an end time `until` [s] is given, at least 1e-15 of that.
void require_step_size(double h, const std::string& option, double until = 0);

// Throws InvalidInput unless the absolute tolerance [m and m/s] is below one of Options::length and
// Options::speed, without which no error counts, and above 1e-30 of both, the rounding of a
// rounding. One of zero is none.
void require_atol(const Options& options);

// What hardly can mean anything of tolerances that are allowed, in a sentence; empty where nothing
// is to be said: an rtol above 0.1 or below 1e-14, an atol above the size of positions or of
// velocities.
std::string tolerance_warning(const Options& options);

}  // namespace qddot::command
