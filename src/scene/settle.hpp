#pragma once

#include <string>

#include "qddot/analysis/equilibrium.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot {

// The stable equilibrium that is reached downhill from the scene's initial positions; the size of
// the scene is the diagonal of the box around its nodes. The scene must have been reduced to
// Reductions::all_directions() at most: rest may lie where a reduced motion never comes.
Equilibrium equilibrium_of(const ReducedScene& scene);

// The scene with its nodes at that equilibrium and its velocities as drawn; it no longer asks to
// start there. Throws InvalidInput, in one sentence that starts with `source` and names the node
// that moved farthest, where there is no equilibrium or none is reached.
Scene settled(const Scene& scene, const std::string& source);

}  // namespace qddot
