#pragma once

#include <vector>

#include "experiments/kit/csv.hpp"
#include "experiments/scaling/scaling_run.hpp"

namespace qddot::scaling {

// A row of roofline.csv: f at one size, beside the peak of the machine [operations/s].
struct RooflineRow {
  ScalingSize size;
  double peak;
};

Columns<PhaseCost> cost_columns();
Columns<Exponent> exponent_columns();
Columns<RooflineRow> roofline_columns();

// Prints them for people.
void print(const std::vector<Exponent>& exponents);
void print(const std::vector<RooflineRow>& roofline, double peak);
void print(const std::vector<LeftOut>& left_out);

}  // namespace qddot::scaling
