#pragma once

#include <string>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "qddot/measure/speed/chart.hpp"

namespace qddot::work_precision {

// The columns and rows of front.csv; rows without a fastest method have empty fields.
extern const std::vector<std::string> front_columns;
void tabulate(Csv& csv, const std::string& scene, const Chart& chart);

// Prints the rows of a chart as a table for people, with a warning of small stability margins.
void print_front(const std::string& scene, const Chart& chart);

}  // namespace qddot::work_precision
