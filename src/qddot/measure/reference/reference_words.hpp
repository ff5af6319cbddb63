#pragma once

#include <string>

#include "qddot/measure/reference/reference.hpp"

namespace qddot::inline measure {

// A sentence that names the scales of errors against the reference, with their values.
std::string what_divides(const Reference& reference);

// A sentence on symmetry: whether the motion exists in exact symmetry alone and what a push does to
// it, or that this took too long to find out. Empty otherwise.
std::string symmetry_in_words(const Reference& reference);

}  // namespace qddot::inline measure
