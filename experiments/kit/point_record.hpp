#pragma once

#include <nlohmann/json.hpp>

#include "experiments/kit/study.hpp"
#include "qddot/integrators/integrator.hpp"
#include "qddot/measure/speed/measurement.hpp"

// The records of a run's Summary and Counts in a journal, by the names of their members; Seconds
// are left out. They are in the namespace of these types, where nlohmann::json looks for them.
namespace qddot {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Counts, steps, rejected, force_evaluations,
                                   stiffness_evaluations, factorizations, solves, newton_iterations,
                                   indefinite_factorizations, order_sum, order_reductions,
                                   stability_limited_steps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Summary, outcome, t_reached, counts, message, energy_growth,
                                   failed_step)

}  // namespace qddot

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
