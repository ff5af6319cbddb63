#pragma once

#include <string>
#include <vector>

#include "experiments/kit/command_line.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline kit {

// Adds --max-order, --stability-detection, --iterations, --solve-tolerance, --spectral-radius and
// --solver.
void add_method_options(CommandLine& line, Options& options);

// Throws InvalidInput unless each option that is given is allowed for some method, or for this one.
void require_options(const CommandLine& line, const Options& options);
void require_options(const CommandLine& line, const Options& options, const Method& method);

// Those of these options that the method listens to.
std::vector<std::string> options_taken_by(const Method& method);

}  // namespace qddot::inline kit
