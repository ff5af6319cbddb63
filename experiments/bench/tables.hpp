#pragma once

#include <string>
#include <vector>

#include "experiments/bench/ratios.hpp"
#include "experiments/bench/same_steps.hpp"
#include "experiments/kit/csv.hpp"

namespace qddot::bench {

// The rows of bench.csv, ratios.csv and same_steps.csv, each of a scene that runs to `until` [s].
struct PointRow {
  const std::string& scene;
  double until;
  const PeerLadder& ladder;
  const Measured& point;
};
struct RatioRow {
  const std::string& scene;
  double until;
  bool is_smallest;  // whether our methods run with all reductions
  const Ratio& ratio;
};
struct SameStepsRow {
  const std::string& scene;
  double until;
  const SameSteps& same;
};
const Columns<PointRow>& point_columns();
const Columns<RatioRow>& ratio_columns();
const Columns<SameStepsRow>& same_steps_columns();

// Prints that row for people.
void print_same_steps(const SameStepsRow& row);

// Prints ratios for people: a line for each peer, a column for each accuracy.
void print_ratios(const std::vector<Ratio>& ratios, const std::vector<double>& accuracies,
                  const std::string& heading);

}  // namespace qddot::bench
