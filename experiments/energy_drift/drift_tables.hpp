#pragma once

#include "experiments/kit/csv.hpp"
#include "qddot/measure/trend/drift_run.hpp"

namespace qddot::energy_drift {

// The tables of energy_drift: drift.csv, summary.csv and tolerance.csv.

// A row for each point of a run's path.
struct PathPoint {
  const DriftRun& run;
  const DriftPoint& point;
};
Columns<PathPoint> path_columns();

// The row of a run. `until`: its asked end [s]; `compensated`: whether methods that can were asked
// for compensated sums.
struct SummaryRow {
  const DriftRun& run;
  double until;
  bool compensated;
};
Columns<SummaryRow> summary_columns();

// How an adaptive method did at its tolerance, one row.
struct ToleranceRow {
  const DriftRun& run;
  const MotionScales& scales;
};
Columns<ToleranceRow> tolerance_columns();

// Prints the verdict on each run. Then prints, for each adaptive method, the exponent of rtol by
// which its error goes, at the time that all its runs reached.
void print_verdicts(const std::vector<DriftRun>& runs, double until);
void print_tolerances(const std::vector<DriftRun>& runs, const MotionScales& scales);

}  // namespace qddot::energy_drift
