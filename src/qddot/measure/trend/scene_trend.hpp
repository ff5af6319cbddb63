#pragma once

#include "qddot/measure/trend/drift_run.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline measure {

// Runs the method on the scene to the time `until` [s], for `seconds` of wall time at most, and
// returns the trends of its energy and momenta. Samples are some thousands of multiples of
// options.step_size, also for adaptive methods, whose default is until/1e5. Throws as Simulation
// does.
DriftRun energy_trend(const Scene& scene, const Method& method, const Options& options,
                      double until, double seconds = 60);

}  // namespace qddot::inline measure
