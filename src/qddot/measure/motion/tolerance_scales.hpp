#pragma once

#include "qddot/integrators/integrator.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// Sets the sizes of positions and velocities that absolute tolerances are relative to. The size of
// positions is the largest extent L [m] of the scene at its start. The size of velocities [m/s] is
// the larger of two speeds. One is that of the fastest node, without motion in closed form. The
// other is sqrt(a L), with a the largest acceleration at the start; it is w L for w^2 = a/L. The
// second is the speed that a node can gain across the scene (under gravity alone, sqrt(g L)). L is
// 1 m for a scene without extent; the speed is L/s for a scene at rest in balance.
Options with_tolerance_scales(Options options, const Model& scene);

}  // namespace qddot::inline measure
