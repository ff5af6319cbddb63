#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/kit/scene_choice.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline kit {

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
