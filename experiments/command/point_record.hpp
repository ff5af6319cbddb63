#pragma once

#include "experiments/command/study.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::command {

using namespace measure;

// A point as a journal keeps it, with all its numbers, and back. point_of throws
// nlohmann::json::exception for anything else.
nlohmann::json record_of(const Point& point);
Point point_of(const nlohmann::json& record);

// Points that are pieces of the study, named by `prefix`, method and value: what Effort::recall
// takes. Borrows the study.
std::function<Point(const Method&, double, const Effort::Take&)> points_of(Study& study,
                                                                           std::string prefix = {});

}  // namespace qddot::command
