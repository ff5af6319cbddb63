#pragma once

#include <string>
#include <vector>

#include "experiments/csv.hpp"
#include "experiments/measurement.hpp"

namespace qddot {

// The columns of points.csv, and one row of it; what was not measured is an empty field. The last
// two are what is known of the position error where the reference is off by up to `certified`.
const std::vector<std::string>& point_columns();
void point_row(Csv& csv, const std::string& scene, const Point& point, double certified);

}  // namespace qddot
