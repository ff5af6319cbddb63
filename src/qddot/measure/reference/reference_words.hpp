#pragma once

#include <string>

#include "qddot/measure/reference/reference.hpp"

namespace qddot::inline measure {

// The scales that errors against the reference are divided by, with their values, in a sentence.
std::string what_divides(const Reference& reference);

// A sentence that says whether the motion exists in exact symmetry alone and what a push does to
// it, or that finding out took too long. Empty otherwise.
std::string symmetry_in_words(const Reference& reference);

}  // namespace qddot::inline measure
