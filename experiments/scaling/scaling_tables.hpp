#pragma once

#include "experiments/kit/csv.hpp"
#include "experiments/scaling/scaling_run.hpp"

namespace qddot::scaling {

// Writes scaling.csv, exponents.csv and roofline.csv, and prints them for people, with what was
// left out. `peak`: that of the machine [operations/s].
void write_tables(const ScalingResults& results, double peak, CsvFile& costs, CsvFile& exponents,
                  CsvFile& roofline);

}  // namespace qddot::scaling
