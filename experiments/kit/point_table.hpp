#pragma once

#include <string>

#include "experiments/kit/columns.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline kit {

// A row of points.csv: a point of a scene whose reference has an error of up to `certified`.
struct PointRow {
  const std::string& scene;
  const Point& point;
  double certified;
};

// The columns of points.csv; fields of values that were not measured are empty.
const Columns<PointRow>& point_columns();

}  // namespace qddot::inline kit
