#pragma once

#include <string>
#include <vector>

#include "experiments/bench/ratios.hpp"
#include "experiments/bench/same_steps.hpp"
#include "experiments/kit/csv.hpp"

namespace qddot::bench {

std::vector<std::string> point_columns();
void point_row(Csv& csv, const std::string& scene, double until, const Sweep& sweep,
               const Measured& point);

std::vector<std::string> ratio_columns();
void ratio_row(Csv& csv, const std::string& scene, double until, bool smallest, const Ratio& ratio);

std::vector<std::string> same_steps_columns();
void same_steps_row(Csv& csv, const std::string& scene, double until, const SameSteps& same);

// Prints that row for people.
void print_same_steps(const std::string& scene, double until, const SameSteps& same);

// Prints what is in the rows of ratios for people: a line for each peer, a column for each
// accuracy.
void print_ratios(const std::vector<Ratio>& ratios, const std::vector<double>& accuracies,
                  const std::string& heading);

}  // namespace qddot::bench
