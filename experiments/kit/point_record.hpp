#pragma once

#include "experiments/kit/study.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline kit {

// Converts a point to its record in a journal, with all its numbers, and back. point_of throws
// nlohmann::json::exception for anything else.
nlohmann::json record_of(const Point& point);
Point point_of(const nlohmann::json& record);

// A function for Effort::recall whose points are pieces of the study, named by `prefix`, method and
// value. The progress shows each point before it is measured, after the text `shown`. Borrows the
// study.
std::function<Point(const Method&, double, const Effort::Take&)> points_of(Study& study,
                                                                           std::string prefix = {},
                                                                           std::string shown = {});

}  // namespace qddot::inline kit
