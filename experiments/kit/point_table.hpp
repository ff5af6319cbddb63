#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

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

// Notes on a table of points, for its sidecar and for all who show the table. "methods": the name,
// "summary" and options ("takes") of each method among the points. "outcomes": a sentence for each
// outcome of a point that failed.
nlohmann::json notes_on(const std::vector<Point>& points);

}  // namespace qddot::inline kit
