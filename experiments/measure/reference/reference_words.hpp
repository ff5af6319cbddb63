#pragma once

#include <string>

#include "qddot/measure/reference/reference.hpp"

namespace qddot::measure {

// What errors against the reference are divided by, with the numbers; a sentence.
std::string what_divides(const Reference& reference);

// That the motion exists in exact symmetry alone and what a push does to it, or that this took too
// long to find out; empty where nothing is to be said.
std::string symmetry_in_words(const Reference& reference);

}  // namespace qddot::measure
