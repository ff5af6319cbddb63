#pragma once

#include <string>
#include <vector>

#include "experiments/command/csv.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::command {

using namespace measure;

// The columns of points.csv, and one row of it; what was not measured is an empty field. The last
// two are what is known of the position error where the reference is off by up to `certified`.
const std::vector<std::string>& point_columns();
void point_row(Csv& csv, const std::string& scene, const Point& point, double certified);

}  // namespace qddot::command
