#pragma once

#include <string>

#include "qddot/integrators/method.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::stability_map {

// How a run is made and judged: by its energy above that at rest, X = E - V(rest), which the exact
// motion keeps.
struct RunPlan {
  double rest_energy = 0;  // V at rest [J]
  double tolerated = 0.5;  // the part of X that may be lost or gained
  double until = 0;        // [s]; at least `least_steps` steps are taken
  double seconds = 1;      // of computation
};
constexpr int least_steps = 100;

// What became of a run. `outcome` is
//   bounded      X keeps its size (that of Verlet's may oscillate by much, near its limit)
//   diverged     X grew beyond ten times what it was and went on growing, or beyond all bounds
//   indefinite_matrix   of linearly implicit methods: X jumped beyond ten times what it was from
//                where compressed springs made M - h^2 K singular or nearly so (h times the rate at
//                which they push to the side above 0.9)
//   gained       X ended up above 1 + tolerated of what it was, on the mean of the last quarter
//   leaked       X ended up below 1 - tolerated
//   unconverged  of methods that take as many iterations as they are told: with five times as
//                many the motion is another one, by a tenth of its size
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

// Runs the method from scene.initial() and judges. X is looked at after each of the first 200 steps
// and 400 times more. Growth is fitted to the later half of where X exceeds three times what it was
// (all of it where that is short), or, where it does not stay there, of the run.
RunOutcome run_outcome(const Method& method, const Options& options, const ReducedScene& scene,
                       const RunPlan& plan);

}  // namespace qddot::stability_map
