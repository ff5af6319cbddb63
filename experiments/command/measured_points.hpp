#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/command/scene_choice.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::command {

using namespace measure;

// What work_precision left in a folder: its points, and what it was told of the runs.
struct MeasuredPoints {
  std::string scene_hash;              // of the scene as drawn
  double until = 0;                    // [s]
  std::vector<std::string> no_reduce;  // what was left in the scene
  Options options;                     // beside the knob
  nlohmann::json key;                  // of the study
  std::vector<Point> points;  // what was not measured is no number; of the counts the steps
};

// Reads points.csv and its sidecar in `folder`. Throws InvalidInput, in a sentence that names the
// file, where either is missing or not as work_precision writes it.
MeasuredPoints measured_points(const std::string& folder);

}  // namespace qddot::command
