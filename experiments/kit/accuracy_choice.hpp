#pragma once

#include <string>
#include <vector>

#include "experiments/kit/command_line.hpp"
#include "qddot/measure/advice/solve.hpp"

namespace qddot::inline kit {

// Adds --accuracy-of.
void add_accuracy_of_option(CommandLine& line, std::string& of);

// The value of --accuracy-of; throws InvalidInput for anything but positions, path and energy.
AccuracyOf accuracy_of(const std::string& of);

// Throws InvalidInput unless the accuracy given to `option` is one that can be reached.
void require_allowed_accuracy(double accuracy, const std::string& option = "--accuracy");

}  // namespace qddot::inline kit
