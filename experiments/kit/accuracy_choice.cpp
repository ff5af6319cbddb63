#include "experiments/kit/accuracy_choice.hpp"

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {

void add_accuracy_of_option(CommandLine& line, std::string& of) {
  line.add_option("--accuracy-of", of,
                  "the error that --accuracy bounds: positions (at the end), path (positions at "
                  "all times) or energy (at all times) (default: positions)");
}

AccuracyOf accuracy_of(const std::string& of) {
  if (of.empty() || of == "positions") return AccuracyOf::positions;
  if (of == "path") return AccuracyOf::path;
  if (of == "energy") return AccuracyOf::energy;
  throw InvalidInput(fmt::format("--accuracy-of {}: allowed are positions, path and energy", of));
}

void require_allowed_accuracy(double accuracy, const std::string& option) {
  if (accuracy >= least_accuracy && accuracy < 1) return;
  throw InvalidInput(
      fmt::format("{} {:g} is not allowed; it is a relative error from 1e-14 (rounding) to below 1 "
                  "(as large as the motion)",
                  option, accuracy));
}

}  // namespace qddot::inline kit
