#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/scene_choice.hpp"
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

// The results of work_precision in a folder: its points, and the settings of the runs.
struct MeasuredPoints {
  std::string scene_hash;              // of the scene as drawn
  double until = 0;                    // [s]
  std::vector<std::string> no_reduce;  // reductions that were left out
  Options options;                     // beside the knob
  nlohmann::json key;                  // of the study
  std::vector<Point> points;           // NaN if not measured; of the counts the steps alone
};

// The points of points.csv in `folder`. Throws InvalidInput, in a sentence that names the file, if
// it is missing or not as work_precision writes it.
std::vector<Point> points_in(const std::string& folder);

// Reads points.csv and its sidecar in `folder`. Throws InvalidInput, in a sentence that names the
// file, if one is missing or not as work_precision writes it.
MeasuredPoints measured_points(const std::string& folder);

}  // namespace qddot::inline kit
