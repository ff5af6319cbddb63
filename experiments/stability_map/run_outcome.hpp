#pragma once

#include <string>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::stability_map {

// The settings of a run and of its verdict, which depends on the energy above rest, X = E -
// V(rest). The exact motion conserves X.
struct RunPlan {
  double rest_energy = 0;  // V at rest [J]
  double tolerated = 0.5;  // the part of X that may be lost or gained
  double until = 0;        // [s]; at least `least_steps` steps are taken
  double seconds = 1;      // of computation
};
constexpr int least_steps = 100;

// The outcome of a run, where X is its energy above rest. `outcome` is
//   bounded      X keeps its size (with Verlet's method it may oscillate much near its limit)
//   diverged     X grew beyond ten times its start value and went on growing, or beyond all bounds
//   indefinite_matrix
//                of linearly implicit methods: X jumped beyond ten times its start value at a state
//                where compressed springs made M - h^2 K singular or nearly so (h times the rate at
//                which they push sideways above 0.9)
//   gained       X ended above 1 + tolerated of its start value, on the mean of the last quarter
//   leaked       X ended below 1 - tolerated
//   unconverged  of methods with a given number of iterations: five times as many change the motion
//                by a tenth of its size
// or the name of the outcome with which the integrator itself failed.
struct RunOutcome {
  std::string outcome;
  double growth_rate = 0;  // of the amplitude, half the slope of ln X [1/s]
  double t_reached = 0;    // [s]
  double energy_end = 0;   // X over X(0), on the mean of the last quarter
  double energy_max = 0;   // likewise the largest
  double mean_step = 0;    // [s]
  Counts counts{};
};

// Runs the method from scene.initial() and judges the run. X is measured after each of the first
// 200 steps and 400 times more. If X stays above three times its start value, growth is fitted to
// the second half of that time, or all of it if it is short. Else it is fitted to the second half
// of the run.
RunOutcome run_outcome(const Method& method, const Options& options, const Model& scene,
                       const RunPlan& plan);

}  // namespace qddot::stability_map
