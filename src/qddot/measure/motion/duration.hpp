#pragma once

#include <string>

namespace qddot::inline measure {

// A duration [s] in words, from "5.2 s" to "3.1e+05 years".
std::string duration_in_words(double seconds);

}  // namespace qddot::inline measure
