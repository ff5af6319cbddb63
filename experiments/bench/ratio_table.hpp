#pragma once

#include <string>
#include <vector>

#include "experiments/bench/ratios.hpp"
#include "experiments/command/csv.hpp"

namespace qddot::bench {

using namespace measure;

using namespace command;

std::vector<std::string> point_columns();
void point_row(Csv& csv, const std::string& scene, double until, const Sweep& sweep,
               const Measured& point);

std::vector<std::string> ratio_columns();
void ratio_row(Csv& csv, const std::string& scene, double until, bool smallest, const Ratio& ratio);

// Prints what is in the rows for people: a line for each peer, a column for each accuracy.
void print_ratios(const std::vector<Ratio>& ratios, const std::vector<double>& accuracies,
                  const std::string& heading);

}  // namespace qddot::bench
