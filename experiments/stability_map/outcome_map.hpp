#pragma once

#include <optional>
#include <vector>

#include "experiments/kit/csv.hpp"
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

// The methods whose whole runs are mapped: all but SUNDIALS' fixed steps, which have hand-written
// twins. `are_named`: the user named the methods, adaptive ones too.
std::vector<const Method*> mapped(const std::vector<const Method*>& methods, bool are_named);

// A run of each method for each row and each h w_max; an adaptive method has one for each
// tolerance.
std::vector<Cell> cells_of(const std::vector<const Method*>& methods,
                           const std::vector<AmplitudeRow>& rows,
                           const std::vector<double>& h_omegas);

// The outcomes of cells; those of cells that were not run are empty.
using Outcomes = std::vector<std::optional<RunOutcome>>;
// Runs all cells on all cores (OpenMP), the long ones first, and fills `all`, one outcome for each
// cell. Each is a piece of the study. Throws Interrupted if cells are left.
void run_outcomes(Study& study, const std::vector<Cell>& cells, const MapSettings& settings,
                  Outcomes& all);

// Writes map.csv.
void tabulate(Csv& csv, const std::vector<Cell>& cells, const Outcomes& all);
// Prints the number of runs of each method by outcome.
void print(const std::vector<Cell>& cells, const Outcomes& all);

}  // namespace qddot::stability_map
