#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline kit {

// Notes on a table of points, for its sidecar and for all who show the table. "methods": the name,
// "summary" and options ("takes") of each method among the points. "outcomes": a sentence for each
// outcome of a point that failed.
nlohmann::json notes_on(const std::vector<Point>& points);

}  // namespace qddot::inline kit
