#pragma once

#include <string>
#include <vector>

#include "experiments/command/csv.hpp"
#include "qddot/measure/trend/drift_run.hpp"

namespace qddot::energy_drift {

using namespace measure;
using namespace command;

// The tables of energy_drift: drift.csv, summary.csv and tolerance.csv.
extern const std::vector<std::string> drift_columns, summary_columns, tolerance_columns;

// A row for each point of the run's path.
void write_path(CsvFile& csv, const DriftRun& run);

// What became of the run, one row. `until`: how far it should have come [s]; `compensated`: whether
// methods that can were asked to keep what rounding takes from their sums.
void write_summary(Csv& csv, const DriftRun& run, double until, bool compensated);

// How an adaptive method did at its tolerance, one row.
void write_tolerance(Csv& csv, const DriftRun& run, const MotionScales& scales);

}  // namespace qddot::energy_drift
