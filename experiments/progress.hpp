#pragma once

#include <string>

#include "experiments/measurement.hpp"

namespace qddot {

// One line on a terminal that is written over; nothing where the output is kept.
void show_progress(const std::string& what);

// A point in one line, for people.
std::string describe(const Point& point);

}  // namespace qddot
