#pragma once

#include <string>

#include "qddot/integrators/integrator.hpp"

namespace qddot::inline kit {

// Throws InvalidInput unless `value` is finite and greater than zero.
void require_positive(double value, const std::string& option, const std::string& meaning);

// Throws InvalidInput unless `value` is from `low` to `high`.
void require_within(int value, int low, int high, const std::string& option);

// Throws InvalidInput unless --repeats, the number of timed runs of a point, is 1 to 1000.
void require_repeats(int repeats);

// Throws InvalidInput, naming what is missing, if `text` is empty.
void require_given(const std::string& text, const std::string& option, const std::string& meaning);

// Throws InvalidInput unless the relative tolerance is from 1e-15 to below 1. Errors below 1e-15
// cannot be told from the several roundings of 2.2e-16 in a step. A tolerance of 1 allows an error
// as large as the motion.
void require_rtol(double rtol, const std::string& option);

// Throws InvalidInput unless h [s] is finite and greater than 0 and has a square of full precision.
// If an end time `until` [s] is given, h must be at least 1e-15 of it.
void require_step_size(double h, const std::string& option, double until = 0);

// Throws InvalidInput unless the absolute tolerance [m and m/s] is zero (none), or below
// Options::length or Options::speed and above 1e-30 of both. No error would count against a larger
// one; a smaller one is the rounding of a rounding.
void require_atol(const Options& options);

// A sentence on allowed tolerances that hardly make sense: an rtol above 0.1 or below 1e-14, an
// atol above the size of positions or of velocities. Empty for all others.
std::string tolerance_warning(const Options& options);

}  // namespace qddot::inline kit
