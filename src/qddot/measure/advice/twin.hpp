#pragma once

#include <optional>

#include "qddot/measure/advice/trial.hpp"
#include "qddot/measure/reference/divergence.hpp"

namespace qddot::inline measure {

// Repeats the trial from a start that is one rounding away, for `seconds` at most, and measures how
// the two part. Empty if the repetition does not reach the end.
std::optional<Divergence> parting_of_twins(const Stage& stage, const Trial& trial, double seconds);

}  // namespace qddot::inline measure
