#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/stability_map/run_outcome.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"

namespace qddot::stability_map {

// A scene at one amplitude of its motion, and its properties by linear theory.
struct AmplitudeRow {
  double amplitude;
  std::unique_ptr<Model> scene;
  double rest_energy;       // V at rest [J]
  double omega_max;         // at the start [rad/s]
  double buckling_rate;     // likewise [1/s], zero if no spring pushes sideways
  std::vector<Mode> modes;  // about the start
};

// The largest natural frequency [rad/s] at the start; zero if nothing vibrates.
double omega_max_of(const Model& scene);

// The scenes that the scene's generator draws with its parameter `vary` at each of the amplitudes.
// Throws InvalidInput if there is no such generator or parameter, or no amplitude is possible.
// If `vary` is empty, each node's distance from its place at rest is multiplied by an amplitude,
// and velocities likewise: 1 is the scene itself. Without an equilibrium `rest` there are no rows.
// Rows in which nothing moves or vibrates are left out, and those whose scene cannot exist or has
// no equilibrium; stderr says which.
std::vector<AmplitudeRow> rows_of(const Subject& subject, const Reductions& reductions,
                                  const std::optional<Scene>& rest, const std::string& vary,
                                  const std::vector<double>& amplitudes);

// One run of the map.
struct Cell {
  const Method* method;
  const AmplitudeRow* row;
  double h_omega;  // requested h w_max; 0 if the method chooses its steps
  double rtol;     // the tolerance of such a method; 0 for others
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
