#include "experiments/kit/accuracy_choice.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {

Argument<std::string> accuracy_of_option(Program& program) {
  return program.word("--accuracy-of",
                      "the error that --accuracy bounds: positions (at the end), path (positions "
                      "at all times) or energy (at all times) (default: positions)");
}

AccuracyOf accuracy_of(const std::string& of) {
  if (of.empty() || of == "positions") return AccuracyOf::positions;
  if (of == "path") return AccuracyOf::path;
  if (of == "energy") return AccuracyOf::energy;
  throw InvalidInput(fmt::format("--accuracy-of {}: allowed are positions, path and energy", of));
}

void require_allowed_accuracy(double accuracy, const std::string& option) {
  try {
    require_accuracy(accuracy, option);
  } catch (const std::invalid_argument& error) {
    throw InvalidInput(error.what());
  }
}

}  // namespace qddot::inline kit
