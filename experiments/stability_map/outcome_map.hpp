#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "experiments/kit/study.hpp"
#include "experiments/stability_map/amplitude_rows.hpp"
#include "experiments/stability_map/run_outcome.hpp"

namespace qddot::stability_map {

// One run of the map.
struct Cell {
  const Method* method;
  const AmplitudeRow* row;
  double h_omega;  // requested h w_max; nothing if the method chooses its steps:
  double rtol;     // then its tolerance
};

// The settings by which runs are made and judged.
struct MapSettings {
  double until, tolerated, seconds;
};

// The largest growth rate [1/s] of a mode by linear theory; negative if all modes decay. NaN for a
// method that chooses its steps, that has no step on an oscillator, or whose step overflows.
double predicted_growth_rate(const Cell& cell);

// Runs all cells on all cores (OpenMP), the long ones first; each is a piece of the study. Cells
// that were not run before an interruption are empty. `progress` is called with the number of cells
// that are done, from one thread at a time.
std::vector<std::optional<RunOutcome>> run_outcomes(
    Study& study, const std::vector<Cell>& cells, const MapSettings& settings,
    const std::function<void(std::size_t done)>& progress);

}  // namespace qddot::stability_map
