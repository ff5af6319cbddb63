#pragma once

#include <string>
#include <vector>

#include "experiments/kit/program.hpp"
#include "qddot/measure/advice/solve.hpp"

namespace qddot::inline kit {

// Adds --accuracy-of.
Argument<std::string> accuracy_of_option(Program& program);

// The value of --accuracy-of; throws InvalidInput for anything but positions, path and energy.
AccuracyOf accuracy_of(const std::string& of);

// Throws InvalidInput unless the accuracy given to `option` is one that can be reached.
void require_allowed_accuracy(double accuracy, const std::string& option = "--accuracy");

}  // namespace qddot::inline kit
