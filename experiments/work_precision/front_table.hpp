#pragma once

#include <string>

#include "qddot/measure/speed/chart.hpp"

namespace qddot::work_precision {

// Prints the rows of a chart as a table for people, with a warning of small stability margins.
void print_front(const std::string& scene, const Chart& chart);

}  // namespace qddot::work_precision
