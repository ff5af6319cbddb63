#pragma once

#include <string>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::command {

using namespace measure;

// One line on a terminal that is written over; nothing where the output is kept.
void show_progress(const std::string& what);

// A point in one line, for people.
std::string describe(const Point& point);

}  // namespace qddot::command
