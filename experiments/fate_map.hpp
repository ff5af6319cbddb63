#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/amplitude_rows.hpp"
#include "experiments/fate.hpp"

namespace qddot {

// One run of the map.
struct Cell {
  const Method* method;
  const AmplitudeRow* row;
  double h_omega;  // h w_max asked for; nothing where the method chooses its steps:
  double rtol;     // then this is its tolerance
};

// How runs are made and judged.
struct MapSettings {
  double until, tolerated, seconds;
};

// The largest rate [1/s] at which linear theory lets one of the modes grow, or, where all decay,
// the smallest decay as a negative one; no number for a method that chooses its steps, or that has
// no step on an oscillator, or whose step is too long for numbers.
double predicted_growth_rate(const Cell& cell);

// Runs all cells on all cores (OpenMP), the long ones first. What is found is kept in `file`, a
// line a cell, as it comes; those that are there already from a run with the same `key` are not run
// again. `progress` is called with how many of them are done, from one thread at a time.
std::vector<Fate> fates(const std::vector<Cell>& cells, const MapSettings& settings,
                        const std::string& file, const std::string& key,
                        const std::function<void(std::size_t done)>& progress);

}  // namespace qddot
