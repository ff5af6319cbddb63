#pragma once

#include "experiments/bench/comparison.hpp"
#include "experiments/kit/csv.hpp"

namespace qddot::bench {

// Prints its ratios, and steps beside peers', for people.
void print(const Comparison& c);

// Adds its rows to bench.csv, ratios.csv and same_steps.csv.
void add_rows(const Comparison& c, CsvFile& points, CsvFile& all_ratios, CsvFile& same_steps);

}  // namespace qddot::bench
