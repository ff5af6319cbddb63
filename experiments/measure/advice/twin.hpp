#pragma once

#include <optional>

#include "qddot/measure/advice/trial.hpp"
#include "qddot/measure/reference/divergence.hpp"

namespace qddot::measure {

// How the trial's run parts from the same run of a start that is one rounding away, which is made
// for that; nothing where that does not come to the end in so many seconds.
std::optional<Divergence> parting_of_twins(const Stage& stage, const Trial& trial, double seconds);

}  // namespace qddot::measure
