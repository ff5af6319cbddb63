#pragma once

#include <string>
#include <vector>

#include "experiments/kit/program.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline kit {

// Throws InvalidInput unless each option that is given is allowed for some method, or for this one.
void require_options(const Program& program, const Options& options);
void require_options(const Program& program, const Options& options, const Method& method);

// Those of these options that the method listens to.
std::vector<std::string> options_taken_by(const Method& method);

}  // namespace qddot::inline kit
