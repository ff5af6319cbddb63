#pragma once

#include <string>
#include <vector>

#include "experiments/symmetric_roots/orbit_swing.hpp"

namespace qddot::spurious_roots {

// A row of roots.csv: one formula. The last three are NaN if it is not stable at the h w `at`.
struct FormulaPoint {
  int steps;
  std::string method;  // empty where it is none of the registry's
  std::vector<double> cosines;
  double limit, phase_error, gap, energy_swing;
};

// The registry's formulas.
std::vector<FormulaPoint> registered_points(double at, const OrbitSwing& orbit);

// Formulas of so many steps, `samples` for each of their pairs of roots: the more pairs, the more
// sets it takes to fill their space. Throws Interrupted.
std::vector<FormulaPoint> sampled_points(int steps, int samples, double at,
                                         const OrbitSwing& orbit);

}  // namespace qddot::spurious_roots
