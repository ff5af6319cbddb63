#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/task.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::sweep {

// The results of work_precision on one scene, in its folder.
struct SceneResult {
  std::string label;
  std::size_t entry = 0;  // of the study's list
  std::map<std::string, double> varied{};
  double until = 0;  // [s]
  Reference reference;
  std::vector<Point> points;
};

// Reads what work_precision left in `folder`. Throws InvalidInput where it is not as it was
// written.
SceneResult read_result(const Task& task, const std::string& folder);

// The accuracies of the task's study, from coarse to fine.
std::vector<double> accuracies_of(const Task& task);

// Writes `path`, fastest.csv: at each accuracy the fastest method on each scene, the next, and how
// many times as long that takes.
void write_fastest(const std::string& path, const std::vector<SceneResult>& results,
                   const std::vector<double>& accuracies, const nlohmann::json& origin);

// Writes `path`, crossovers.csv. A row has two neighbouring values of a generator's parameter, or
// end times, between which the fastest method changes while all else is equal. It also has the
// value at which both methods take equally long. That is the zero of the line through the logarithm
// of the ratio of their times, over the logarithm of the parameter. `margin`: how many times as
// long the other method takes at either end, at least. The largest margins come first; those near 1
// are within the variation of times.
void write_crossovers(const std::string& path, const std::vector<SceneResult>& results,
                      const std::vector<double>& accuracies, const nlohmann::json& origin);

// Prints how often each method is the fastest at each accuracy, and by how much.
void print_winners(const std::vector<SceneResult>& results, const std::vector<double>& accuracies);

}  // namespace qddot::sweep
