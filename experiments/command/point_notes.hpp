#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::command {

using namespace measure;

// What those who show a table of points say beside it, for the table's sidecar: "methods", of each
// method among the points its name, the line on it ("summary") and which options it listens to
// ("takes"); "outcomes", for each way in which one of them failed a sentence on it.
nlohmann::json notes_on(const std::vector<Point>& points);

}  // namespace qddot::command
