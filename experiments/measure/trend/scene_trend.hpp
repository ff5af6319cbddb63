#pragma once

#include "qddot/measure/trend/drift_run.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::measure {

// Where a scene's energy and momenta go when the method runs it for `until` [s], for `seconds` at
// most. It is looked at at some thousands of multiples of options.step_size; of adaptive methods
// too, for which until/1e5 is taken where none is given. Throws as Simulation does.
DriftRun energy_trend(const Scene& scene, const Method& method, const Options& options,
                      double until, double seconds = 60);

}  // namespace qddot::measure
