#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/integrators/integrator.hpp"
#include "qddot/integrators/nearest_name.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {

class Program;
template <class T>
class Argument;

// Throws InvalidInput unless `value` is finite and greater than zero.
void require_positive(double value, const std::string& option, const std::string& meaning);

// Throws InvalidInput unless `value` is from `low` to `high`.
void require_within(int value, int low, int high, const std::string& option);

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

// The entry of that name. Throws InvalidInput, with the names of all, if there is none; `option`
// and `what` it names are for the sentence.
template <class Entry>
const Entry& named(const std::string& name, const std::vector<Entry>& all,
                   std::string Entry::*own_name, const std::string& option,
                   const std::string& what) {
  const auto found = std::ranges::find(all, name, own_name);
  if (found != all.end()) return *found;
  std::vector<std::string> names;
  for (const Entry& entry : all) names.push_back(entry.*own_name);
  const std::string nearest = nearest_name(name, names);
  throw InvalidInput(fmt::format("{}: {} is not {}{}; allowed are {}", option, name, what,
                                 nearest.empty() ? "" : ", the nearest is " + nearest,
                                 fmt::join(names, ", ")));
}

// Throws InvalidInput if a value of the list is there twice.
template <class T>
void require_each_once(const std::vector<T>& values, const std::string& option) {
  for (auto value = values.begin(); value != values.end(); ++value) {
    if (std::find(values.begin(), value, *value) != value)
      throw InvalidInput(fmt::format("{}: {} is named twice; allowed is once", option, *value));
  }
}

// Throws InvalidInput unless each option that is given is allowed for some method, or for this one.
void require_options(const Program& program, const Options& options);
void require_options(const Program& program, const Options& options, const Method& method);

// Those of these options that the method listens to.
std::vector<std::string> options_taken_by(const Method& method);

// Whether the option of a program is one of those that methods take.
bool decides_how_a_method_runs(const std::string& option);

// Adds --accuracy-of.
Argument<std::string> accuracy_of_option(Program& program);

// The value of --accuracy-of; throws InvalidInput for anything but positions, path and energy.
AccuracyOf accuracy_of(const std::string& of);

// Throws InvalidInput unless the accuracy given to `option` is one that can be reached.
void require_allowed_accuracy(double accuracy, const std::string& option = "--accuracy");

}  // namespace qddot::inline kit
