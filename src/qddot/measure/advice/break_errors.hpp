#pragma once

#include <vector>

#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/breaks.hpp"

namespace qddot::inline measure {

// Bounds of the errors of the times at which springs broke in a trial [s], in the order of its
// breaks: differences to the runs that bound its error, counted twenty times. Infinite
// where no other run says anything.
std::vector<double> break_errors(const Search& search, const Trial& trial);

}  // namespace qddot::inline measure
