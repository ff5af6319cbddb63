#pragma once

#include "qddot/integrators/integrator.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::measure {

// The options with the sizes that absolute tolerances are measured by: of positions, the largest
// extent L [m] of the scene as it starts; of velocities, the larger of the fastest node's (beside
// what falls in closed form) and of
// sqrt(a L) [m/s], a the largest acceleration at the start, or w L with w^2 = a/L: what the start
// can bring a node to across the scene (under gravity alone, sqrt(g L)). L is 1 m for a scene
// without extent, the speed L/s for one that rests in balance.
Options with_tolerance_scales(Options options, const ReducedScene& scene);

}  // namespace qddot::measure
